// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <meshfarm/farm/membership.hpp>

namespace meshfarm {
namespace {

constexpr int k_silent_until_lost = 3;
// The pause between looks starts short, since a run's processes start together, and doubles. An
// existing endpoint gets some time to answer.
constexpr FarmTime k_first_look{5};
constexpr FarmTime k_first_answer{50};
constexpr FarmTime k_look_every{500};
/// After this many unanswered greetings a new connection is made: the routing id may be held by a
/// dead connection that the ventilator has not noticed yet.
constexpr int k_greetings_per_dial = 10;
constexpr std::uint32_t k_shortest_heartbeat_ms = 10;
constexpr std::uint32_t k_longest_heartbeat_ms = 60'000;

}  // namespace

FarmTime poll_interval(FarmTime heartbeat) {
  return std::clamp(heartbeat / 4, FarmTime(5), FarmTime(100));
}

Membership::Event Membership::tick(FarmTime now) {
  if (joined_) {
    return heard_ + k_silent_until_lost * heartbeat_ < now ? lose(now) : Event::none;
  }
  if (!alone_since_) alone_since_ = now;
  if (now - *alone_since_ <= options_.patience) return Event::none;
  const std::string waited =
      std::to_string(std::chrono::duration_cast<std::chrono::seconds>(options_.patience).count());
  if (dialled_) {
    reason_ = "no answer from the ventilator at " + dialled_->address + " (host " + dialled_->host +
              ", pid " + std::to_string(dialled_->pid) + ") for ";
  } else if (seen_over_) {
    reason_ = "the runs of this stage are over, and no ventilator came for another in ";
  } else if (seen_other_run_) {
    reason_ = "only ventilators of another run (is the target the same?) were in the stage for ";
  } else {
    reason_ = "no ventilator announced itself in the stage for ";
  }
  reason_ += waited + " s; start 'meshfarm run' or 'meshfarm ventilator' on this stage";
  return Event::expired;
}

Membership::Event Membership::on_message(const Message& message, FarmTime now) {
  if (!dialled_) return Event::none;
  if (const auto* welcome = std::get_if<Welcome>(&message)) return on_welcome(*welcome, now);
  if (const auto* refused = std::get_if<Refused>(&message)) return on_refused(*refused, now);
  if (const auto* stop = std::get_if<Stop>(&message)) {
    return stop->why == StopReason::run_over ? Event::run_over : lose(now);
  }
  heard_ = now;
  return Event::none;
}

Membership::Event Membership::on_welcome(const Welcome& welcome, FarmTime now) {
  if (welcome.epoch != dialled_->epoch || welcome.run != dialled_->run) return Event::none;
  heard_ = now;
  if (joined_) return Event::none;
  joined_ = true;
  welcome_ = welcome;
  heartbeat_ =
      FarmTime(std::clamp(welcome.heartbeat_ms, k_shortest_heartbeat_ms, k_longest_heartbeat_ms));
  next_beat_ = now;
  first_beat_ = true;
  alone_since_.reset();
  greet_ = false;
  greetings_ = 0;
  return Event::joined;
}

Membership::Event Membership::on_refused(const Refused& refused, FarmTime now) {
  switch (refused.why) {
    case Refusal::stranger:
      return joined_ ? lose(now) : Event::none;
    case Refusal::full:
      return Event::none;  // greets again after a while
    case Refusal::other_run:
    case Refusal::replaced:
    case Refusal::other_build:
      break;
  }
  reason_ = "the ventilator at " + dialled_->address + " refused: " + refused.reason;
  return Event::refused;
}

Membership::Event Membership::found(std::span<const Endpoint> endpoints, FarmTime now) {
  if (joined_) return Event::none;
  std::map<std::uint64_t, const Endpoint*> newest;  // per run that we may serve
  for (const Endpoint& endpoint : endpoints) {
    const bool ours = options_.run == 0 || endpoint.run == options_.run;
    if (ours) newest[endpoint.run] = &endpoint;
    seen_other_run_ = seen_other_run_ || !ours;
  }
  bool was_there = false;
  std::vector<const Endpoint*> live;
  for (const auto& [run, endpoint] : newest) {
    if (!endpoint->address.empty()) {
      live.push_back(endpoint);
      continue;
    }
    seen_over_ = true;
    was_there = was_there || (dialled_ && dialled_->run == run);
  }
  // A member that came after the end, or was never let in, looks for another run instead.
  if (was_there && (live.empty() || welcome_.run == dialled_->run)) return Event::run_over;
  if (live.empty()) return Event::none;
  std::sort(live.begin(), live.end(),
            [](const Endpoint* a, const Endpoint* b) { return a->epoch > b->epoch; });
  greet(*choose(live, now), now);
  return Event::none;
}

/// The newest endpoint, which is the likeliest to answer; the next one if it does not. A member
/// that lost its ventilator stays with the run as long as the ventilator may come back.
const Endpoint* Membership::choose(std::span<const Endpoint* const> live, FarmTime now) {
  const bool is_new = live.front()->epoch > newest_seen_;
  if (is_new) alone_since_ = now;
  newest_seen_ = std::max(newest_seen_, live.front()->epoch);
  const auto same = std::find_if(live.begin(), live.end(), [&](const Endpoint* each) {
    return dialled_ && each->run == dialled_->run;
  });
  if (same == live.end() || (is_new && !lost_)) return live.front();
  if (greetings_ < k_greetings_per_dial || std::exchange(lost_, false)) return *same;
  return same + 1 == live.end() ? live.front() : *(same + 1);
}

void Membership::greet(const Endpoint& endpoint, FarmTime now) {
  const bool other = !dialled_ || dialled_->epoch != endpoint.epoch;
  if (other || greetings_ >= k_greetings_per_dial) {
    dialled_ = endpoint;
    dial_ = true;
    greetings_ = 0;
    look_pause_ = k_first_answer;
    next_look_ = now + look_pause_;
  }
  ++greetings_;
  greet_ = true;
}

bool Membership::look_due(FarmTime now) {
  if (joined_ || (next_look_ && now < *next_look_)) return false;
  next_look_ = now + look_pause_;
  look_pause_ = std::min(2 * look_pause_, k_look_every);
  return true;
}

FarmTime Membership::pause(FarmTime now) const {
  const FarmTime pause = poll_interval(heartbeat_);
  if (joined_ || !next_look_) return pause;
  return std::clamp(*next_look_ - now, FarmTime(1), pause);
}

std::optional<std::string> Membership::dial() {
  if (!std::exchange(dial_, false)) return std::nullopt;
  return dialled_->address;
}

std::optional<Hello> Membership::hello() {
  if (!std::exchange(greet_, false)) return std::nullopt;
  return Hello{options_.role, options_.run,     options_.incarnation, options_.pid,
               options_.host, options_.results, options_.capacity,    options_.algorithm};
}

/// A fraction of a heartbeat, given by the member's incarnation, so that members that joined
/// together (for example after a ventilator restart) do not keep sending at the same time.
FarmTime Membership::second_beat_after() const {
  constexpr std::uint64_t k_shares = 1023;
  const std::uint64_t share = options_.incarnation % k_shares;
  return heartbeat_ * static_cast<FarmTime::rep>(share) / k_shares;
}

bool Membership::beat_due(FarmTime now) {
  if (!joined_ || now < next_beat_) return false;
  next_beat_ = now + (std::exchange(first_beat_, false) ? second_beat_after() : heartbeat_);
  return true;
}

Membership::Event Membership::lose(FarmTime now) {
  joined_ = false;
  alone_since_ = now;
  next_look_.reset();
  look_pause_ = k_first_look;
  // The same endpoint is dialled again: it may have lost us, not we it.
  greetings_ = k_greetings_per_dial;
  lost_ = true;
  return Event::lost;
}

}  // namespace meshfarm
