// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What the sink trusts, and how it handles damage.
#include <utility>

#include <meshfarm/farm/sink_core.hpp>

namespace meshfarm {

void SinkCore::take_in(const Check& check) {
  if (check.what != Check::What::result) {
    const bool left = check.left_to_readers && !found_damage_;
    known_.looked_at(check.key, check.output, left);
    Check read{check.key, check.output, Check::What::accepted, {}, 0, {}, check.kind};
    left ? void(left_.insert_or_assign(check.key, std::move(read))) : act(std::move(read));
  }
  if (graph_.waits_for(check.key)) return want(accept(check));
  // The graph was restarted meanwhile, and has not reached this job yet.
  known_.add(check.key, check.output);
}

/// Called when something may be damaged.
void SinkCore::read_what_was_left() {
  for (auto& [key, check] : std::exchange(left_, {})) {
    known_.looked_at(key, check.output, false);
    act(std::move(check));
  }
}

/// A result that was accepted by its size has been read.
void SinkCore::verified(const Check& check, const JobFailure& problem) {
  if (problem.reason.empty()) {
    known_.verified(check.key);
  } else {
    known_.forget(check.key);
    if (graph_.accepted(check.key) != nullptr) damaged_.insert(check.key);
    found_damage_ = true;
    read_what_was_left();
  }
  if (unverified() > 0) return;
  if (!found_damage_) held_.clear();
  if (told_all_) say_where_it_stands();
  look_for_end();
}

/// Reports nothing until it is known whose fault it is. A worker may be the first to notice a
/// damaged result: then no host is to blame, and retrying is useless before that result is made
/// again.
std::optional<JobFailure> SinkCore::failure_to_tell(const Result& result,
                                                    const JobFailure& failure) {
  if (!told_all_) return std::nullopt;
  const bool damaged = failure.kind == FailureKind::damaged_input;
  if (!damaged || !wanted_.at(result.key).needs_others) return failure;
  read_what_was_left();
  const std::pair attempt(result.key, result.attempt);
  if (unverified() > 0) {
    held_.insert(attempt);
    return std::nullopt;
  }
  if (!found_damage_ || !held_.contains(attempt)) return failure;
  return JobFailure{failure.reason, FailureKind::unread};
}

/// Like a new sink that knows everything except the damaged results.
void SinkCore::begin_again(FarmTime now) {
  for (const JobKey key : accepted_) {
    if (!damaged_.contains(key)) known_.add(key, *graph_.accepted(key));
  }
  damaged_.clear();
  accepted_.clear();
  wanted_.clear();
  own_.clear();
  waiting_.clear();
  graph_ = source_();
  if (told_all_) on(member_.on_message(Stop{StopReason::leaving}, now), now);
  want(graph_.begin());
  tell_all();
}

}  // namespace meshfarm
