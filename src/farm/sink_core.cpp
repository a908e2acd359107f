// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/farm/plan.hpp>
#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// What there is no room for is retried after this pause, which doubles each time.
constexpr FarmTime k_first_pause{1000};
constexpr FarmTime k_longest_sink_pause{5000};
/// The output takes longer to try.
constexpr FarmTime k_longest_output_pause{60'000};
/// Up to this size, reading a result takes hardly longer than checking its size.
constexpr std::uint64_t k_large_bytes = std::uint64_t{256} << 10;

/// For a sink that does not wait for room: adds how to continue.
SinkProblem as_last_words(SinkProblem problem) {
  if (problem.no_room) problem.text += k_after_making_room;
  return problem;
}

}  // namespace

SinkActions SinkCore::tick(FarmTime now) {
  if (phase_ == Phase::left) return take();
  if (!std::exchange(begun_, true)) want(graph_.begin());
  const Membership::Event event = member_.tick(now);
  // While the output is being made nobody needs the ventilator, which may come back meanwhile.
  const bool busy = phase_ == Phase::making_output;
  if (event != Membership::Event::expired || !busy) on(event, now);
  if (member_.look_due(now)) act(Look{});
  if (again_at_ && now >= *again_at_) try_again();
  if (!damaged_.empty() && phase_ == Phase::collecting) begin_again(now);
  if (member_.beat_due(now)) {
    Heartbeat beat;
    beat.epoch = member_.welcome().epoch;
    beat.progress = graph_.jobs_accepted();
    beat.no_room = waits_for_room();
    say(beat);
    if (told_all_) say_again();
  }
  if (phase_ == Phase::saying_complete && say_until_ < now) {
    leave(SinkLeaves::Why::complete, "no ventilator acknowledged the end");
  }
  if (phase_ == Phase::saying_failed && say_until_ < now) leave_for_problem();
  return take();
}

SinkActions SinkCore::found(std::span<const Endpoint> endpoints, FarmTime now) {
  if (phase_ == Phase::left) return take();
  on(member_.found(endpoints, now), now);
  if (auto address = member_.dial()) act(Dial{std::move(*address)});
  if (auto hello = member_.hello()) act(Say{std::move(*hello)});
  return take();
}

SinkActions SinkCore::on_control(const Message& message, FarmTime now) {
  if (phase_ == Phase::left) return take();
  on(member_.on_message(message, now), now);
  if (const auto* failed = std::get_if<JobFailed>(&message)) failed_[failed->key] = *failed;
  return take();
}

void SinkCore::on(Membership::Event event, FarmTime now) {
  switch (event) {
    case Membership::Event::none:
      return;
    case Membership::Event::joined:
      told_all_ = false;
      failed_.clear();  // the new ventilator repeats what it gave up
      if (phase_ == Phase::saying_complete) say_until_ = now + member_.options().patience;
      return tell_all();
    case Membership::Event::lost:
      told_all_ = false;
      return act(HangUp{});
    case Membership::Event::run_over:
      return run_over();
    case Membership::Event::refused:
      return leave(SinkLeaves::Why::incomplete, member_.reason());
    case Membership::Event::expired:
      if (phase_ == Phase::collecting) leave(SinkLeaves::Why::incomplete, member_.reason());
      return;
  }
}

void SinkCore::run_over() {
  switch (phase_) {
    case Phase::collecting:
      if (!failed_.empty()) return leave_for_failed_jobs();
      return leave(SinkLeaves::Why::incomplete, "the ventilator ended the run before its end");
    case Phase::saying_complete:
      return leave(SinkLeaves::Why::complete, {});
    case Phase::saying_failed:
      return leave_for_problem();
    case Phase::making_output:
    case Phase::left:
      return;
  }
}

SinkActions SinkCore::on_result(const Message& message) {
  const auto* result = std::get_if<Result>(&message);
  const bool ours = result != nullptr && result->run == member_.options().run &&
                    result->epoch >= member_.epoch() && graph_.wanted(result->key);
  if (!ours || phase_ == Phase::left) {
    ++dropped_;
  } else {
    take_result(*result);
  }
  return take();
}

void SinkCore::take_result(const Result& result) {
  if (graph_.accepted(result.key) != nullptr) return tell(result.key, result.worker);
  if (const auto* said = std::get_if<JobFailure>(&result.outcome)) {
    const auto failure = failure_to_tell(result, *said);
    if (!failure) return;  // the worker repeats its result
    return say(Reject{member_.epoch(), result.worker, result.attempt, result.key, *failure, {}});
  }
  const auto& output = std::get<JobOutput>(result.outcome);
  const ResultName name{result.key.value, result.attempt, result.incarnation};
  if (output.file.name != to_string(name)) {
    ++dropped_;
    return;
  }
  const bool looks = output.file.size >= k_large_bytes && !found_damage_;
  Check check{result.key, output, looks ? Check::What::large : Check::What::result};
  check.worker = result.worker;
  check.attempt = result.attempt;
  check.times = result.times;
  check.kind = wanted_.at(result.key).kind;
  check.left_to_readers = wanted_.at(result.key).left_to_readers;
  if (checking_.try_emplace(result.key, check).second) act(check);
}

SinkActions SinkCore::checked(const Check& check, const JobFailure& problem, FarmTime now) {
  if (phase_ == Phase::left) return take();
  const bool fine = problem.reason.empty();
  if (check.what == Check::What::accepted) {
    verified(check, problem);
    return take();
  }
  if (problem.kind == FailureKind::no_space) {
    if (when_full_ == WhenFull::end) return fail(as_last_words({problem.reason, true}));
    unwritten_.push_back(check);
    wait_for_room(k_longest_sink_pause, now);
    return take();
  }
  checking_.erase(check.key);
  // A retried result may be damaged by now: then nothing is left to wait for. Records are short:
  // when there is room for one, there may still be too little for a job of the sink.
  if ((fine || checking_.empty()) && !again_at_ && lack_room_.empty()) again_pause_ = FarmTime(0);
  const bool known = check.what == Check::What::known;
  if (known) --looking_;
  if (fine) {
    take_in(check);
  } else if (known) {
    known_.forget(check.key);
    const auto own = own_.find(check.key);
    if (own != own_.end()) do_here({own->first, own->second});
  } else if (check.worker == WorkerId{}) {
    return fail({problem.reason, false});
  } else if (told_all_) {
    const JobFailure failure{clipped(problem.reason), problem.kind};
    say(Reject{member_.epoch(), check.worker, check.attempt, check.key, failure,
               check.output.file});
  }
  tell_all();
  return take();
}

/// Jobs that are possible now; those known from a journal are checked at once.
void SinkCore::want(std::vector<WantedJob> jobs) {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const auto [key, job, name] = std::move(jobs[i]);
    wanted_[key] = {job.kind, !graph_.needs(name).empty(), job.left_to_readers};
    if (job.by_sink) own_[key] = job;
    const JobOutput* known = known_.find(key);
    if (known == nullptr) {
      if (job.by_sink) do_here({key, job});
      continue;
    }
    const Check check{key, *known, Check::What::known, {}, 0, {}, job.kind, job.left_to_readers};
    if (known_.is_trusted(key)) {
      for (WantedJob& each : accept(check)) jobs.push_back(std::move(each));
    } else if (checking_.try_emplace(key, check).second) {
      ++looking_;
      act(check);
    }
  }
  look_for_end();
}

/// Returns the jobs that become possible.
std::vector<WantedJob> SinkCore::accept(const Check& check) {
  accepted_.push_back(check.key);
  std::vector<WantedJob> possible = graph_.accept(check.key, check.output);
  failed_.erase(check.key);
  tell(check.key, check.worker, check.times);
  return possible;
}

/// A job of the sink reads accepted results, so all must be verified.
void SinkCore::do_here(const DoHere& what) {
  if (unverified() > 0) return waiting_.push_back(what);
  if (doing_.insert(what.key).second) act(what);
}

void SinkCore::look_for_end() {
  if (unverified() > 0 || phase_ != Phase::collecting) return;
  for (const DoHere& each : std::exchange(waiting_, {})) do_here(each);
  if (!graph_.complete()) return;
  phase_ = Phase::making_output;
  act(MakeOutput{});
}

void SinkCore::tell_all() {
  if (told_all_ || !member_.joined() || !begun_ || looking_ > 0) return;
  told_all_ = true;
  for (const JobKey key : accepted_) tell(key, WorkerId{});
  say_where_it_stands();
}

/// Repeats what nobody would ask for if it got lost: workers repeat their results until answered.
void SinkCore::say_again() {
  for (const auto& [key, job] : own_) {
    if (graph_.accepted(key) != nullptr) tell(key, WorkerId{});
  }
  say_where_it_stands();
}

void SinkCore::say_where_it_stands() {
  say(Ready{member_.epoch(), accepted_.size(), unverified()});
  if (phase_ == Phase::saying_complete) say(Complete{member_.epoch()});
  if (phase_ == Phase::saying_failed) {
    say(Failed{member_.epoch(), clipped(problem_.text), problem_.no_room});
  }
}

void SinkCore::tell(JobKey key, WorkerId worker, const JobTimes& times) {
  if (!told_all_) return;
  say(Accept{member_.epoch(), worker, key, *graph_.accepted(key), times, unverified()});
}

SinkActions SinkCore::did(const DoHere& what, const JobOutput& output, const SinkProblem& problem,
                          FarmTime now) {
  if (phase_ == Phase::left) return take();
  if (problem.no_room && when_full_ == WhenFull::wait) {
    not_done_.push_back(what);
    lack_room_.insert(what.key);
    wait_for_room(k_longest_output_pause, now);
    return take();
  }
  doing_.erase(what.key);
  lack_room_.erase(what.key);
  if (!problem.text.empty()) return fail(as_last_words(problem));
  if (!again_at_ && lack_room_.empty()) again_pause_ = FarmTime(0);
  const Check check{what.key, output, Check::What::result, {}, 0, what.times, what.job.kind};
  if (checking_.try_emplace(what.key, check).second) act(check);
  return take();
}

SinkActions SinkCore::completed(const SinkProblem& problem, FarmTime now) {
  if (phase_ == Phase::left) return take();
  if (problem.no_room && when_full_ == WhenFull::wait) {
    wait_for_room(k_longest_output_pause, now);
    return take();
  }
  again_pause_ = FarmTime(0);
  say_until_ = now + member_.options().patience;
  phase_ = Phase::saying_complete;
  if (!problem.text.empty()) return fail(as_last_words(problem));
  if (told_all_) say_where_it_stands();
  return take();
}

void SinkCore::wait_for_room(FarmTime longest, FarmTime now) {
  if (again_at_) return;
  again_pause_ = again_pause_.count() == 0 ? k_first_pause : std::min(2 * again_pause_, longest);
  again_at_ = now + again_pause_;
}

void SinkCore::try_again() {
  again_at_.reset();
  for (Check& each : std::exchange(unwritten_, {})) act(std::move(each));
  for (DoHere& each : std::exchange(not_done_, {})) act(std::move(each));
  if (phase_ == Phase::making_output) act(MakeOutput{});
}

SinkActions SinkCore::fail(const SinkProblem& problem) {
  problem_ = problem;
  phase_ = Phase::saying_failed;
  if (told_all_) {
    say_where_it_stands();
  } else {
    leave_for_problem();
  }
  return take();
}

SinkActions SinkCore::stop() {
  if (phase_ != Phase::left) {
    leave(SinkLeaves::Why::incomplete,
          "stopped; what was accepted is kept in the stage, run the same command again to go on");
  }
  return take();
}

void SinkCore::leave(SinkLeaves::Why why, std::string message) {
  phase_ = Phase::left;
  act(SinkLeaves{why, std::move(message)});
}

void SinkCore::leave_for_failed_jobs() {
  const auto whole_run = failed_.find(k_whole_run);
  if (whole_run != failed_.end()) {
    return leave(
        whole_run->second.resumable ? SinkLeaves::Why::incomplete : SinkLeaves::Why::jobs_failed,
        whole_run->second.reason);
  }
  std::vector<std::string> reasons;
  bool resumable = true;
  for (const auto& [key, failed] : failed_) {
    reasons.push_back(to_hex(key.value) + ": " + failed.reason);
    resumable = resumable && failed.resumable;
  }
  leave(resumable ? SinkLeaves::Why::incomplete : SinkLeaves::Why::jobs_failed,
        failed_for_good(reasons));
}

void SinkCore::leave_for_problem() {
  leave(problem_.no_room ? SinkLeaves::Why::incomplete : SinkLeaves::Why::output_failed,
        problem_.text);
}

SinkActions SinkCore::take() {
  return std::exchange(out_, {});
}

}  // namespace meshfarm
