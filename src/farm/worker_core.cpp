// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/farm/worker_core.hpp>

namespace meshfarm {
namespace {

/// A result that nobody acknowledged is sent again after so many heartbeats.
constexpr int k_resend_heartbeats = 5;

}  // namespace

WorkerActions WorkerCore::tick(std::uint64_t progress, FarmTime now) {
  if (left_ || leaving_) return take();
  on(member_.tick(now), now);
  if (member_.look_due(now)) act(Look{});
  if (member_.beat_due(now)) {
    const Welcome& joined = member_.welcome();
    act(Say{Heartbeat{joined.epoch, joined.worker, held(), received_, progress}});
    if (credit_ > 0) act(Say{Credit{joined.epoch, joined.worker, credit_}});
  }
  if (member_.joined() && !sink_.empty()) {
    for (auto& [key, kept] : unacknowledged_) {
      if (kept.sent + k_resend_heartbeats * member_.heartbeat() <= now) send_result(kept, now);
    }
  }
  return take();
}

WorkerActions WorkerCore::found(std::span<const Endpoint> endpoints, FarmTime now) {
  if (left_ || leaving_) return take();
  on(member_.found(endpoints, now), now);
  if (auto address = member_.dial()) act(Dial{std::move(*address)});
  if (auto hello = member_.hello()) act(Say{std::move(*hello)});
  return take();
}

WorkerActions WorkerCore::on_control(const Message& message, FarmTime now) {
  if (left_ || leaving_) return take();
  on(member_.on_message(message, now), now);
  if (!member_.joined()) return take();
  if (const auto* done = std::get_if<Done>(&message)) forget(*done);
  if (const auto* sink = std::get_if<SinkAt>(&message)) sink_is_at(sink->results, now);
  if (const auto* alive = std::get_if<Alive>(&message)) sink_is_at(alive->sink, now);
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
    // The lane lost a job: only a fresh membership makes both sides agree again on who holds what.
    on(member_.on_message(Stop{StopReason::leaving}, now), now);
    return take();
  }
  received_ = assignment->lane_seq;
  waiting_.push_back(*assignment);
  begin_next();
  raise_credit();
  return take();
}

WorkerActions WorkerCore::finished(std::variant<JobOutput, JobFailure> outcome, FarmTime now) {
  if (left_) return take();
  const InWork ended = *std::exchange(in_work_, std::nullopt);
  if (leaving_) {
    leave(incomplete_);
    return take();
  }
  if (ended.wanted) {
    ++(outcome.index() == 0 ? report_.jobs_done : report_.jobs_failed);
    Kept& kept = unacknowledged_[ended.key];
    kept.result = {run_,          0,         WorkerId{},        member_.options().incarnation,
                   ended.attempt, ended.key, std::move(outcome)};
    kept.sent = now;
    if (member_.joined() && !sink_.empty()) send_result(kept, now);
  }
  begin_next();
  raise_credit();
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
      if (in_work_) in_work_->on_this_lane = false;
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
    if (in_work_) {
      in_work_->wanted = false;
      act(GiveUp{});
    }
    run_ = welcome.run;
  }
  received_ = 0;
  credit_ = 0;
  act(ConnectLane{welcome.lane});
  sink_is_at(welcome.sink, now);
  raise_credit();
}

void WorkerCore::leave(std::string incomplete) {
  waiting_.clear();
  if (!leaving_ && in_work_) act(GiveUp{});
  leaving_ = true;
  incomplete_ = std::move(incomplete);
  if (in_work_) return;
  left_ = true;
  act(Leave{incomplete_});
}

void WorkerCore::forget(const Done& done) {
  const auto kept = unacknowledged_.find(done.key);
  if (kept != unacknowledged_.end() && kept->second.result.attempt <= done.attempt) {
    unacknowledged_.erase(kept);
  }
  std::erase_if(waiting_, [&](const Assignment& each) {
    return each.attempt <= done.attempt && key_of(each.job) == done.key;
  });
  const bool in_work = in_work_ && in_work_->key == done.key && in_work_->attempt <= done.attempt;
  if (in_work && in_work_->wanted) {
    in_work_->wanted = false;
    act(GiveUp{});
  }
  raise_credit();
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
  if (in_work_ || waiting_.empty()) return;
  Assignment next = std::move(waiting_.front());
  waiting_.pop_front();
  in_work_ = InWork{key_of(next.job), next.attempt, true, true};
  act(Begin{next.attempt, std::move(next.job)});
}

void WorkerCore::raise_credit() {
  if (!member_.joined()) return;
  const bool idle = waiting_.empty() && !in_work_;
  // The paper, 3.2: a batch is applied for when the input buffer is less than 0.8 full.
  if (!idle && waiting_.size() * 10 >= std::uint64_t{buffer_} * 8) return;
  const bool on_lane = in_work_ && in_work_->on_this_lane;
  const std::uint64_t begun_or_gone = received_ - waiting_.size() - (on_lane ? 1 : 0);
  const std::uint64_t room = std::uint64_t{buffer_} + (in_work_ && !on_lane ? 0 : 1);
  if (begun_or_gone + room <= credit_) return;
  credit_ = begun_or_gone + room;
  act(Say{Credit{member_.epoch(), member_.welcome().worker, credit_}});
}

std::uint32_t WorkerCore::held() const {
  return static_cast<std::uint32_t>(waiting_.size() + (in_work_ ? 1 : 0));
}

WorkerActions WorkerCore::take() {
  return std::exchange(out_, {});
}

}  // namespace meshfarm
