// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {
namespace {

/// Whoever is silent for this many heartbeats is lost.
constexpr int k_silent_heartbeats = 3;
/// Attempt numbers go on from epoch to epoch, so that a worker which outlives a ventilator never
/// publishes two results under one name.
constexpr std::uint32_t k_attempts_per_epoch = 1000;

}  // namespace

Actions Dispatcher::on_message(const PeerId& peer, const Message& message, FarmTime now) {
  now_ = std::max(now_, now);
  if (!finished_) std::visit([&](const auto& body) { on(peer, body); }, message);
  return take();
}

Actions Dispatcher::tick(FarmTime now) {
  now_ = std::max(now_, now);
  const FarmTime patience = k_silent_heartbeats * options_.heartbeat;
  while (!finished_ && !by_heard_.empty() && by_heard_.begin()->first + patience < now_) {
    const WorkerId id = by_heard_.begin()->second;
    lose(id, "was silent for " + std::to_string(k_silent_heartbeats) + " heartbeats",
         Blame::first_held);
  }
  if (!finished_ && sink_ && sink_->heard + patience < now_) lose_sink();
  issue();
  return take();
}

Actions Dispatcher::leave() {
  to_workers(Stop{StopReason::leaving});
  if (sink_) send(sink_->peer, Stop{StopReason::leaving});
  finished_ = true;
  return take();
}

// --- joining

void Dispatcher::on(const PeerId& peer, const Hello& hello) {
  if (hello.run != options_.run && (hello.run != 0 || hello.role == Role::sink)) {
    send(peer, Refused{Refusal::other_run, "this ventilator's run is " + to_hex(options_.run)});
    return;
  }
  if (hello.role == Role::sink) return sink_joins(peer, hello);
  worker_joins(peer, hello);
}

void Dispatcher::worker_joins(const PeerId& peer, const Hello& hello) {
  if (over_) return send(peer, Stop{StopReason::run_over});
  if (const auto known = by_peer_.find(peer); known != by_peer_.end()) {
    Worker& worker = workers_.at(known->second);
    hear(known->second, worker);
    if (!worker.lane.empty()) welcome(known->second, worker);
    return;
  }
  const auto before = by_incarnation_.find(hello.incarnation);
  if (before != by_incarnation_.end()) lose(before->second, "joined again", Blame::none);
  if (const auto charge = charges_.find(hello.incarnation); charge != charges_.end()) {
    plan_.forgive(charge->second.key, charge->second.reason);  // it lives: no job has killed it
    charges_.erase(charge);
  }
  const WorkerId id{next_worker_++};
  Worker& worker = workers_[id];
  worker.peer = peer;
  worker.incarnation = hello.incarnation;
  worker.host = hello.host;
  worker.capacity = hello.capacity;
  worker.heard = now_;
  by_peer_[peer] = id;
  by_incarnation_[hello.incarnation] = id;
  by_heard_.insert({now_, id});
  out_.push_back(OpenLane{id});
}

Actions Dispatcher::lane_opened(WorkerId id, const std::string& address) {
  const auto found = workers_.find(id);
  if (found != workers_.end()) {
    found->second.lane = address;
    welcome(id, found->second);
  }
  return take();
}

Actions Dispatcher::lane_failed(WorkerId id, const std::string& reason) {
  const auto found = workers_.find(id);
  if (found != workers_.end()) {
    send(found->second.peer, Refused{Refusal::full, clipped(reason)});
    lose(id, reason, Blame::none);
  }
  return take();
}

void Dispatcher::welcome(WorkerId id, const Worker& worker) {
  send(worker.peer, Welcome{id, options_.epoch, options_.run, worker.lane,
                            sink_ ? sink_->results : std::string(),
                            static_cast<std::uint32_t>(options_.heartbeat.count())});
}

void Dispatcher::sink_joins(const PeerId& peer, const Hello& hello) {
  if (replaced_sinks_.contains(hello.incarnation)) {
    return send(peer, Refused{Refusal::replaced, "another sink has taken this one's place"});
  }
  if (!sink_ || sink_->peer != peer) {
    if (last_sink_ != 0 && last_sink_ != hello.incarnation) {
      replaced_sinks_.insert(last_sink_);
      if (sink_) send(sink_->peer, Refused{Refusal::replaced, "another sink took its place"});
    }
    last_sink_ = hello.incarnation;
    sink_ = Sink{peer, hello.incarnation, hello.results, now_, false, {}};
    to_workers(SinkAt{hello.results});
  }
  sink_->heard = now_;
  send(peer, Welcome{WorkerId{},
                     options_.epoch,
                     options_.run,
                     {},
                     {},
                     static_cast<std::uint32_t>(options_.heartbeat.count())});
}

// --- staying

void Dispatcher::on(const PeerId& peer, const Heartbeat& beat) {
  if (sink_ && sink_->peer == peer) {
    sink_->heard = now_;
    return send(peer, Alive{options_.epoch, {}});
  }
  Worker* worker = worker_at(peer, beat.worker, beat.epoch);
  if (worker == nullptr) {
    return send(peer, Refused{Refusal::stranger, "not known here (any more); say hello"});
  }
  const bool unreceived = beat.received < worker->sent;
  if (unreceived && worker->pushed + k_silent_heartbeats * options_.heartbeat < now_) {
    send(peer, Refused{Refusal::stranger, "the lane lost jobs; say hello for another"});
    return lose(beat.worker, "its lane lost jobs", Blame::none);
  }
  send(peer, Alive{options_.epoch, sink_ ? sink_->results : std::string()});
  if (over_) send(peer, Stop{StopReason::run_over});
}

void Dispatcher::on(const PeerId& peer, const Credit& credit) {
  Worker* worker = worker_at(peer, credit.worker, credit.epoch);
  if (worker == nullptr || credit.up_to <= worker->credit) return;
  worker->credit = credit.up_to;
  rank(credit.worker, *worker);
  issue();
}

void Dispatcher::on(const PeerId& peer, const Release& release) {
  Worker* worker = worker_at(peer, release.worker, release.epoch);
  if (worker == nullptr) return;
  lose(release.worker, "left", Blame::none);
}

Dispatcher::Worker* Dispatcher::worker_at(const PeerId& peer, WorkerId id, std::uint32_t epoch) {
  const auto known = by_peer_.find(peer);
  if (known == by_peer_.end() || known->second != id || epoch != options_.epoch) {
    ++dropped_;
    return nullptr;
  }
  Worker& worker = workers_.at(id);
  hear(id, worker);
  return &worker;
}

void Dispatcher::hear(WorkerId id, Worker& worker) {
  by_heard_.erase({worker.heard, id});
  worker.heard = now_;
  by_heard_.insert({now_, id});
}

void Dispatcher::lose(WorkerId id, const std::string& reason, Blame blame) {
  const Worker worker = std::move(workers_.at(id));
  workers_.erase(id);
  by_peer_.erase(worker.peer);
  by_incarnation_.erase(worker.incarnation);
  by_heard_.erase({worker.heard, id});
  if (worker.willing) willing_.erase({*worker.willing, id});
  out_.push_back(CloseLane{id});
  if (blame != Blame::none) ++lost_workers_;
  for (const Held& held : worker.held) {
    holder_.erase(held.key);
    if (blame == Blame::first_held && &held == &worker.held.front()) {
      const std::string why =
          "worker " + std::to_string(id.value) + " on " + worker.host + " " + reason;
      charges_[worker.incarnation] = {held.key, why};
      fail(held.key, why, false);
    } else {
      plan_.give_back(held.key);
    }
  }
  issue();
  look_for_end();
}

void Dispatcher::lose_sink() {
  sink_.reset();
  to_workers(SinkAt{});
}

// --- what the sink says

bool Dispatcher::from_sink(const PeerId& peer, std::uint32_t epoch) {
  if (!sink_ || sink_->peer != peer || epoch != options_.epoch) {
    ++dropped_;
    return false;
  }
  sink_->heard = now_;
  return true;
}

void Dispatcher::on(const PeerId& peer, const Accept& accept) {
  if (!from_sink(peer, accept.epoch)) return;
  if (!sink_->ready) {
    sink_->told[accept.key] = accept.output;
  } else {
    plan_.accept(accept.key, accept.output);
  }
  settle(accept.key, accept.worker);
  issue();
  look_for_end();
}

void Dispatcher::on(const PeerId& peer, const Reject& reject) {
  if (!from_sink(peer, reject.epoch)) return;
  const auto holder = holder_.find(reject.key);
  bool current = false;
  if (holder != holder_.end() && holder->second == reject.worker) {
    const auto& held = workers_.at(reject.worker).held;
    current = std::any_of(held.begin(), held.end(), [&](const Held& each) {
      return each.key == reject.key && each.attempt == reject.attempt;
    });
  }
  const bool for_good = reject.failure.kind == FailureKind::for_good;
  if (current || for_good) {
    fail(reject.key, reject.failure.reason, for_good);
    settle(reject.key, reject.worker);
  } else if (const auto reporter = workers_.find(reject.worker); reporter != workers_.end()) {
    send(reporter->second.peer, Done{reject.key, reject.attempt});
  }
  issue();
  look_for_end();
}

void Dispatcher::on(const PeerId& peer, const Ready& ready) {
  if (!from_sink(peer, ready.epoch) || sink_->ready) return;
  if (ready.accepted != sink_->told.size()) {
    send(peer, Refused{Refusal::stranger, "some of what was accepted got lost; say hello again"});
    return lose_sink();
  }
  sink_->ready = true;
  plan_.restart(std::exchange(sink_->told, {}));
  over_ = over_ && plan_.complete();  // a sink that lost results needs workers again
  for (const LostJob& lost : plan_.lost()) send(peer, JobFailed{lost.key, clipped(lost.reasons)});
  issue();
  look_for_end();
}

void Dispatcher::on(const PeerId& peer, const Complete& complete) {
  if (!from_sink(peer, complete.epoch) || !plan_.complete()) return;
  finish({});
}

void Dispatcher::on(const PeerId& peer, const Failed& failed) {
  if (from_sink(peer, failed.epoch)) finish("the sink failed: " + failed.reason);
}

// --- jobs

std::uint32_t Dispatcher::attempt_number(std::uint32_t attempt) const {
  return k_attempts_per_epoch * (options_.epoch - 1) + attempt;
}

/// Nobody needs the attempts made so far any more: who reported one and who holds one may forget
/// it.
void Dispatcher::settle(JobKey key, WorkerId reporter) {
  const Done done{key, attempt_number(plan_.attempts(key))};
  const auto told = workers_.find(reporter);
  if (told != workers_.end()) send(told->second.peer, done);
  const auto holder = holder_.find(key);
  if (holder == holder_.end()) return;
  if (holder->second != reporter) send(workers_.at(holder->second).peer, done);
  const WorkerId id = holder->second;
  Worker& worker = workers_.at(id);
  holder_.erase(holder);
  std::erase_if(worker.held, [&](const Held& held) { return held.key == key; });
  rank(id, worker);
  plan_.give_back(key);  // where the plan does not call it done or failed: nobody runs it now
}

void Dispatcher::fail(JobKey key, const std::string& reason, bool for_good) {
  const bool was_failed = plan_.state(key) == JobState::failed;
  plan_.fail_attempt(key, reason, for_good);
  if (was_failed || plan_.state(key) != JobState::failed || !sink_ || !sink_->ready) return;
  for (const LostJob& lost : plan_.lost()) {
    if (lost.key == key) send(sink_->peer, JobFailed{key, clipped(lost.reasons)});
  }
}

void Dispatcher::rank(WorkerId id, Worker& worker) {
  if (worker.willing) willing_.erase({*worker.willing, id});
  worker.willing.reset();
  if (worker.lane.empty() || worker.sent >= worker.credit) return;
  worker.willing = worker.held.size();
  willing_.insert({*worker.willing, id});
}

void Dispatcher::issue() {
  while (!finished_ && sink_ && sink_->ready && !willing_.empty() && plan_.counts().ready > 0) {
    // Near the end of a round nobody hoards: the fewer jobs are left, the fewer each may hold.
    const std::size_t fair = 1 + plan_.counts().ready / workers_.size();
    const auto [laden, id] = *willing_.begin();
    if (laden >= fair) return;
    Worker& worker = workers_.at(id);
    IssuedJob issued = *plan_.issue();
    const std::uint32_t attempt = attempt_number(issued.attempt);
    worker.held.push_back({issued.key, attempt});
    worker.pushed = now_;
    ++worker.sent;
    holder_[issued.key] = id;
    rank(id, worker);
    out_.push_back(PushJob{
        id, Assignment{options_.run, options_.epoch, worker.sent, attempt, std::move(issued.job)}});
  }
}

void Dispatcher::look_for_end() {
  if (finished_ || over_) return;
  if (plan_.complete()) {
    over_ = true;
    to_workers(Stop{StopReason::run_over});
  } else if (plan_.stuck()) {
    std::vector<std::string> reasons;
    for (const LostJob& lost : plan_.lost()) {
      reasons.push_back(lost.kind + " " + to_hex(lost.key.value) + ": " + lost.reasons);
    }
    finish(failed_for_good(reasons));
  }
}

void Dispatcher::finish(const std::string& failure) {
  over_ = true;
  to_workers(Stop{StopReason::run_over});
  if (sink_) send(sink_->peer, Stop{StopReason::run_over});
  finished_ = true;
  out_.push_back(Finish{failure});
}

void Dispatcher::to_workers(const Message& message) {
  for (const auto& [id, worker] : workers_) send(worker.peer, message);
}

FarmProgress Dispatcher::progress() const {
  const PlanCounts& counts = plan_.counts();
  FarmProgress progress;
  progress.jobs_done = counts.done;
  progress.jobs_known = counts.ready + counts.running + counts.done + counts.failed;
  progress.cost_done = counts.cost_done;
  progress.cost_known = counts.cost_known;
  progress.jobs_running = counts.running;
  progress.workers = static_cast<std::uint32_t>(workers_.size());
  progress.workers_lost = lost_workers_;
  progress.retries = counts.retries;
  progress.sink_present = sink_.has_value();
  return progress;
}

}  // namespace meshfarm
