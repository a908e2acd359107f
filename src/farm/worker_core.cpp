// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <utility>

#include <meshfarm/farm/worker_core.hpp>

namespace meshfarm {
namespace {

/// A result that nobody acknowledged is sent again after this many heartbeats.
constexpr int k_resend_heartbeats = 5;

}  // namespace

WorkerLimits limits_of(const Capacity& capacity, std::uint32_t buffer) {
  WorkerLimits limits;
  limits.buffer = buffer;
  limits.slots = std::max(1U, capacity.threads) + 1;
  limits.memory = capacity.memory;
  return limits;
}

std::uint64_t WorkerPulse::progress() const {
  std::uint64_t all = 0;
  for (const SlotPulse& slot : slots) all += slot.progress;
  return all;
}

WorkerActions WorkerCore::tick(const WorkerPulse& pulse, FarmTime now) {
  if (leaving_ && !left_) {
    if (!leaving_since_) leaving_since_ = now;
    if (now - *leaving_since_ > limits_.grace) abort(incomplete_);
  }
  if (left_ || leaving_) return take();
  feel(pulse, now);
  on(member_.tick(now), now);
  if (credit_ == 0) raise_credit();
  if (member_.look_due(now)) act(Look{});
  if (member_.beat_due(now)) beat(pulse, now);
  if (member_.joined() && !sink_.empty()) {
    for (auto& [key, kept] : unacknowledged_) {
      if (kept.sent + k_resend_heartbeats * member_.heartbeat() <= now) send_result(kept, now);
    }
  }
  return take();
}

void WorkerCore::beat(const WorkerPulse& pulse, FarmTime now) {
  const Welcome& joined = member_.welcome();
  Heartbeat beat;
  beat.epoch = joined.epoch;
  beat.worker = joined.worker;
  beat.held = static_cast<std::uint32_t>(waiting_.size()) + in_work();
  beat.received = received_;
  beat.progress = pulse.progress();
  beat.rss_bytes = pulse.rss_bytes;
  for (const auto& slot : slots_) {
    // A job that was taken back may wait for storage indefinitely.
    const bool waits = slot && slot->pulse.phase == JobPhase::storage && !slot->on_this_lane;
    const bool counts = slot && !waits && !pulse.slots.empty();
    const FarmTime still = counts ? slot->still(now) : FarmTime(0);
    if (still.count() <= beat.still_ms) continue;
    beat.still = slot->key;
    beat.still_ms = static_cast<std::uint32_t>(std::min<FarmTime::rep>(still.count(), UINT32_MAX));
    beat.in_storage = slot->pulse.phase == JobPhase::storage;
  }
  act(Say{beat});
  if (credit_ > 0) act(Say{Credit{joined.epoch, joined.worker, credit_}});
}

/// Takes the slots' pulses. A job that waits for its turn does not stand still.
void WorkerCore::feel(const WorkerPulse& pulse, FarmTime now) {
  for (std::size_t i = 0; i < std::min(slots_.size(), pulse.slots.size()); ++i) {
    if (!slots_[i]) continue;
    const SlotPulse& felt = pulse.slots[i];
    SlotPulse& known = slots_[i]->pulse;
    const bool moved = felt.progress != known.progress || felt.phase != known.phase;
    if (moved || felt.phase == JobPhase::waiting) {
      slots_[i]->moved = now;
      slots_[i]->moved_cpu_ms = felt.cpu_ms;
    }
    known = felt;
  }
}

FarmTime WorkerCore::InWork::still(FarmTime now) const {
  // A thread with less than this fraction (1/1000) of the time is not computing, but waiting.
  constexpr FarmTime::rep k_least_share = 1000;
  const FarmTime all = now - moved;
  const FarmTime computed(static_cast<FarmTime::rep>(pulse.cpu_ms - moved_cpu_ms));
  const bool computes = pulse.phase == JobPhase::computing && pulse.cpu_ms > moved_cpu_ms &&
                        computed * k_least_share > all;
  return computes ? std::min(computed, all) : all;
}

WorkerActions WorkerCore::found(std::span<const Endpoint> endpoints, FarmTime now) {
  if (left_ || leaving_) return take();
  on(member_.found(endpoints, now), now);
  if (auto address = member_.dial()) act(Dial{std::move(*address)});
  if (auto hello = member_.hello()) act(Say{std::move(*hello)});
  return take();
}

WorkerActions WorkerCore::on_control(const Message& message, FarmTime now) {
  if (left_) return take();
  const auto* stop = std::get_if<Stop>(&message);
  if (stop != nullptr && stop->why == StopReason::hung) {
    abort("a job here stood still and was given to others");
    return take();
  }
  if (leaving_) return take();
  on(member_.on_message(message, now), now);
  if (!member_.joined()) return take();
  if (const auto* done = std::get_if<Done>(&message)) forget(*done);
  if (const auto* sink = std::get_if<SinkAt>(&message)) sink_is_at(sink->results, now);
  if (const auto* read = std::get_if<TryRead>(&message)) act(ReadForSink{*read});
  if (const auto* alive = std::get_if<Alive>(&message)) {
    sink_is_at(alive->sink, now);
    may_take(alive->memory);
    now_ = now;
    begin_next();  // there may be more room
    raise_credit();
  }
  return take();
}

WorkerActions WorkerCore::on_lane(const Message& message, FarmTime now) {
  const auto* assignment = std::get_if<Assignment>(&message);
  if (left_ || leaving_) return take();
  if (assignment == nullptr || !member_.joined() || assignment->epoch != member_.epoch() ||
      assignment->run != member_.welcome().run || assignment->lane_seq <= received_) {
    ++dropped_;
    return take();
  }
  if (assignment->lane_seq != received_ + 1) {
    // The lane lost a job: only a new membership makes both sides agree on who holds what.
    on(member_.on_message(Stop{StopReason::leaving}, now), now);
    return take();
  }
  received_ = assignment->lane_seq;
  waiting_.push_back({key_of(assignment->job), *assignment});
  now_ = now;
  begin_next();
  raise_credit();
  return take();
}

WorkerActions WorkerCore::finished(std::uint32_t slot, std::variant<JobOutput, JobFailure> outcome,
                                   FarmTime now, const JobTimes& times) {
  if (left_) return take();
  const InWork ended = *std::exchange(slots_.at(slot), std::nullopt);
  if (leaving_) {
    leave(incomplete_);
    return take();
  }
  if (ended.wanted) {
    ++(outcome.index() == 0 ? report_.jobs_done : report_.jobs_failed);
    Kept& kept = unacknowledged_[ended.key];
    kept.result = {run_,          0,         WorkerId{},         member_.options().incarnation,
                   ended.attempt, ended.key, std::move(outcome), times};
    kept.sent = now;
    if (member_.joined() && !sink_.empty()) send_result(kept, now);
  }
  now_ = now;
  begin_next();
  raise_credit();
  return take();
}

WorkerActions WorkerCore::tried(const TryRead& what, bool whole) {
  if (!left_ && !leaving_ && member_.joined()) {
    const WorkerId self = member_.welcome().worker;
    act(Say{TriedRead{member_.epoch(), self, what.key, what.attempt, whole}});
  }
  return take();
}

WorkerActions WorkerCore::stop() {
  if (left_ || leaving_) return take();
  if (member_.joined()) act(Say{Release{member_.epoch(), member_.welcome().worker}});
  leave("stopped; what it held was given back");
  return take();
}

void WorkerCore::on(Membership::Event event, FarmTime now) {
  switch (event) {
    case Membership::Event::none:
      return;
    case Membership::Event::joined:
      return join(now);
    case Membership::Event::lost:
      waiting_.clear();
      sink_is_at({}, now);
      for (auto& slot : slots_) {
        if (slot) slot->on_this_lane = false;
      }
      return act(HangUp{});
    case Membership::Event::run_over:
      return leave({});
    case Membership::Event::refused:
    case Membership::Event::expired:
      return leave(member_.reason());
  }
}

void WorkerCore::join(FarmTime now) {
  const Welcome& welcome = member_.welcome();
  if (welcome.run != run_) {
    unacknowledged_.clear();
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) give_up(slot);
    run_ = welcome.run;
  }
  received_ = 0;
  credit_ = 0;
  may_take(welcome.memory);
  act(ConnectLane{welcome.lane});
  sink_is_at(welcome.sink, now);
  raise_credit();
}

void WorkerCore::leave(std::string incomplete) {
  waiting_.clear();
  for (std::uint32_t slot = 0; !leaving_ && slot < slots_.size(); ++slot) give_up(slot);
  leaving_ = true;
  incomplete_ = std::move(incomplete);
  if (in_work() > 0) return;
  left_ = true;
  act(Leave{incomplete_, false});
}

void WorkerCore::abort(std::string incomplete) {
  left_ = true;
  act(Leave{std::move(incomplete), true});
}

void WorkerCore::give_up(std::uint32_t slot) {
  if (!slots_[slot] || !slots_[slot]->wanted) return;
  slots_[slot]->wanted = false;
  act(GiveUp{slot});
}

void WorkerCore::forget(const Done& done) {
  const auto kept = unacknowledged_.find(done.key);
  if (kept != unacknowledged_.end() && kept->second.result.attempt <= done.attempt) {
    unacknowledged_.erase(kept);
  }
  std::erase_if(waiting_, [&](const Waiting& each) {
    return each.key == done.key && each.assignment.attempt <= done.attempt;
  });
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
    const auto& job = slots_[slot];
    if (job && job->key == done.key && job->attempt <= done.attempt) give_up(slot);
  }
  raise_credit();
}

void WorkerCore::may_take(std::uint64_t memory) {
  memory_share_ = memory == 0 ? limits_.memory : std::min(memory, limits_.memory);
}

void WorkerCore::sink_is_at(const std::string& address, FarmTime now) {
  if (sink_ == address) return;
  sink_ = address;
  act(ConnectSink{address});
  if (sink_.empty()) return;
  for (auto& [key, kept] : unacknowledged_) send_result(kept, now);
}

void WorkerCore::send_result(Kept& kept, FarmTime now) {
  kept.sent = now;
  kept.result.epoch = member_.epoch();
  kept.result.worker = member_.welcome().worker;
  act(SendResult{kept.result});
}

void WorkerCore::begin_next() {
  while (!waiting_.empty()) {
    const std::uint64_t memory = waiting_.front().assignment.job.memory;
    const auto slot = free_slot(memory);
    if (!slot) return;
    auto [key, next] = std::move(waiting_.front());
    waiting_.pop_front();
    slots_[*slot] = InWork{key, next.attempt, memory, true, true, {}, now_};
    act(Begin{*slot, next.attempt, key, std::move(next.job)});
  }
}

/// A slot for a job that needs this much memory; the first job always gets one.
std::optional<std::uint32_t> WorkerCore::free_slot(std::uint64_t memory) const {
  std::optional<std::uint32_t> found;
  std::uint64_t taken = 0;
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
    if (slots_[slot]) taken += slots_[slot]->memory;
    if (!slots_[slot] && !found) found = slot;
  }
  const bool fits = limits_.memory == 0 || in_work() == 0 || taken + memory <= memory_share_;
  return fits ? found : std::nullopt;
}

void WorkerCore::raise_credit() {
  if (!member_.joined()) return;
  // If every slot waits for storage with jobs from an earlier lane, request nothing: new jobs would
  // wait here, maybe for long, while others could do them.
  const bool stuck = std::all_of(slots_.begin(), slots_.end(), [](const auto& slot) {
    return slot && !slot->on_this_lane && slot->pulse.phase != JobPhase::computing;
  });
  if (stuck) return;
  std::uint64_t on_lane = 0;
  for (const auto& slot : slots_) on_lane += slot && slot->on_this_lane ? 1 : 0;
  const std::uint64_t busy = in_work();
  const bool idle = waiting_.empty() && busy < slots_.size();
  // The paper, 3.2: a batch is requested when the input buffer is less than 0.8 full.
  if (!idle && waiting_.size() * 10 >= std::uint64_t{limits_.buffer} * 8) return;
  const std::uint64_t begun_or_gone = received_ - waiting_.size() - on_lane;
  const std::uint64_t room = limits_.buffer + slots_.size() - (busy - on_lane);
  if (begun_or_gone + room <= credit_) return;
  credit_ = begun_or_gone + room;
  act(Say{Credit{member_.epoch(), member_.welcome().worker, credit_}});
}

std::uint32_t WorkerCore::in_work() const {
  return static_cast<std::uint32_t>(
      std::count_if(slots_.begin(), slots_.end(), [](const auto& slot) { return bool(slot); }));
}

WorkerActions WorkerCore::take() {
  return std::exchange(out_, {});
}

}  // namespace meshfarm
