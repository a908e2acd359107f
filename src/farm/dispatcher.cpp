// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {
namespace {

/// A peer that is silent for this many heartbeats is lost.
constexpr int k_silent_heartbeats = 3;
/// Storage may take this many times as long as a computation before the job goes to others.
constexpr int k_storage_patience = 4;
/// A job hangs if it makes no progress for this multiple of its estimated time.
constexpr int k_hanging_estimates = 3;

}  // namespace

Actions Dispatcher::on_message(const PeerId& peer, const Message& message, FarmTime now) {
  now_ = std::max(now_, now);
  if (!finished_) std::visit([&](const auto& body) { on(peer, body); }, message);
  return take();
}

Actions Dispatcher::tick(FarmTime now, Inbox inbox) {
  now_ = std::max(now_, now);
  const FarmTime patience = k_silent_heartbeats * options_.heartbeat;
  const bool all_read = inbox == Inbox::empty;
  while (all_read && !finished_ && !by_heard_.empty() &&
         by_heard_.begin()->first + patience < now_) {
    const WorkerId id = by_heard_.begin()->second;
    ++lost_workers_;
    lose(id, "was silent for " + std::to_string(k_silent_heartbeats) + " heartbeats", in_work(id));
  }
  if (all_read && !finished_ && sink_ && sink_->heard + patience < now_) lose_sink();
  look_for_room();
  look_at_doubts();
  issue();
  if (may_issue()) {
    for (Scheduler::Pick& pick : scheduler_.second_attempts(plan_, now_)) push(std::move(pick));
    look_for_memory();
  }
  return take();
}

Actions Dispatcher::leave() {
  to_workers(Stop{StopReason::leaving});
  if (sink_) send(sink_->peer, Stop{StopReason::leaving});
  finished_ = true;
  return take();
}

Actions Dispatcher::end_complete() {
  finish({}, false);
  return take();
}

// --- joining

void Dispatcher::on(const PeerId& peer, const Hello& hello) {
  if (hello.algorithm != options_.algorithm) {
    const std::string ours = std::to_string(options_.algorithm);
    const std::string theirs = std::to_string(hello.algorithm);
    other_build_ =
        hello.host + " simplifies by version " + theirs + " of the algorithm, not " + ours;
    return send(peer, Refused{Refusal::other_build,
                              "it simplifies by version " + ours +
                                  " of the algorithm, this process by version " + theirs +
                                  ": start the same build of meshfarm on all hosts"});
  }
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
  if (const auto before = by_incarnation_.find(hello.incarnation);
      before != by_incarnation_.end()) {
    Worker& worker = workers_.at(before->second);
    if (worker.knows_of_lane()) {
      lose(before->second, "joined again", {});  // messages on their way to it may be lost
    } else {
      return move_to(peer, before->second, worker);
    }
  }
  if (const auto charge = charges_.find(hello.incarnation); charge != charges_.end()) {
    plan_.forgive(charge->second.key, charge->second.reason);  // it is alive, so no job killed it
    charges_.erase(charge);
  }
  const WorkerId id{next_worker_++};
  Worker& worker = workers_[id];
  worker.peer = peer;
  worker.incarnation = hello.incarnation;
  worker.host = hello.host;
  worker.pid = hello.pid;
  worker.capacity = hello.capacity;
  worker.heard = now_;
  by_peer_[peer] = id;
  by_incarnation_[hello.incarnation] = id;
  by_heard_.insert({now_, id});
  scheduler_.join(id, hello.host, hello.capacity);
  tell(WorkerJoined{id, worker.host, worker.pid, worker.capacity});
  out_.push_back(OpenLane{id});
}

/// A worker that keeps greeting without an answer greets over a new connection. It has not been
/// given any jobs, so there is nothing to lose.
void Dispatcher::move_to(const PeerId& peer, WorkerId id, Worker& worker) {
  by_peer_.erase(worker.peer);
  by_peer_[peer] = id;
  worker.peer = peer;
  hear(id, worker);
  if (!worker.lane.empty()) welcome(id, worker);
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
    lose(id, reason, {});
  }
  return take();
}

void Dispatcher::welcome(WorkerId id, const Worker& worker) {
  send(
      worker.peer,
      Welcome{id, options_.epoch, options_.run, worker.lane, sink_ ? sink_->results : std::string(),
              static_cast<std::uint32_t>(options_.heartbeat.count()), scheduler_.memory_share(id)});
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
    sink_ = Sink{peer, hello.incarnation, hello.results, hello.host, now_, false, {}, 0, false};
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
    sink_->no_room = beat.no_room;
    issue();
    return send(peer, Alive{options_.epoch, {}});
  }
  Worker* worker = worker_at(peer, beat.worker, beat.epoch);
  if (worker == nullptr) {
    return send(peer, Refused{Refusal::stranger, "not known here (any more); say hello"});
  }
  // This process may have stalled after pushing, and may be reading older messages now.
  worker->unreceived_beats = beat.received < worker->sent ? worker->unreceived_beats + 1 : 0;
  if (worker->unreceived_beats > k_silent_heartbeats &&
      worker->pushed + k_silent_heartbeats * options_.heartbeat < now_) {
    send(peer, Refused{Refusal::stranger, "the lane lost jobs; say hello for another"});
    return lose(beat.worker, "its lane lost jobs", {});
  }
  worker->beat = beat;
  if (hangs(beat.worker, *worker)) return lose_hanging(beat.worker);
  send(peer, Alive{options_.epoch, sink_ ? sink_->results : std::string(),
                   scheduler_.memory_share(beat.worker)});
  if (over_) send(peer, Stop{StopReason::run_over});
}

void Dispatcher::on(const PeerId& peer, const Credit& credit) {
  Worker* worker = worker_at(peer, credit.worker, credit.epoch);
  if (worker == nullptr || credit.up_to <= worker->credit) return;
  worker->credit = credit.up_to;
  set_room(credit.worker);
  issue();
}

void Dispatcher::on(const PeerId& peer, const Release& release) {
  Worker* worker = worker_at(peer, release.worker, release.epoch);
  if (worker == nullptr) return;
  lose(release.worker, "left", {});
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
  if (worker.heard == now_) return;
  auto node = by_heard_.extract({worker.heard, id});
  worker.heard = now_;
  node.value().first = now_;
  by_heard_.insert(by_heard_.end(), std::move(node));
}

/// Whether a job in work at this worker has stood still for too long.
bool Dispatcher::hangs(WorkerId id, const Worker& worker) const {
  const Heartbeat& beat = worker.beat;
  if (FarmTime(beat.still_ms) < options_.hang) return false;
  if (beat.in_storage) {
    return FarmTime(beat.still_ms) >= k_storage_patience * options_.hang && !storage_stalls();
  }
  double seconds = 0;
  for (const Scheduler::Held& held : scheduler_.held(id)) {
    if (held.key == beat.still) seconds = static_cast<double>(held.cost) / scheduler_.speed(id);
  }
  return beat.still_ms > k_hanging_estimates * 1000 * seconds;
}

/// Whether most of the busy workers wait for the stage: then the storage is stalled, and no other
/// worker could do better.
bool Dispatcher::storage_stalls() const {
  std::size_t working = 0;
  std::size_t waiting = 0;
  for (const auto& [id, worker] : workers_) {
    working += worker.beat.held > 0 ? 1 : 0;
    waiting += worker.beat.in_storage && FarmTime(worker.beat.still_ms) >= options_.hang / 2;
  }
  return 2 * waiting > working;
}

void Dispatcher::lose_hanging(WorkerId id) {
  const Worker& worker = workers_.at(id);
  const Heartbeat beat = worker.beat;
  const std::string seconds = std::to_string(beat.still_ms / 1000) + " s";
  if (beat.in_storage) {
    // Nobody is to blame for slow storage. Others get the jobs; the worker joins again, and its
    // result still counts if it comes first.
    send(worker.peer, Refused{Refusal::stranger, "it waits for the stage; say hello again"});
    return lose(id, "has waited for the stage for " + seconds, {});
  }
  send(worker.peer, Stop{StopReason::hung});
  ++lost_workers_;
  lose(id, "computed and stood still for " + seconds, {beat.still});
}

std::vector<JobKey> Dispatcher::in_work(WorkerId id) const {
  std::vector<JobKey> keys;
  for (const Scheduler::Held& held : scheduler_.held(id)) {
    if (keys.size() < scheduler_.in_work(id)) keys.push_back(held.key);
  }
  return keys;
}

/// `suspects` are the jobs that may have killed the worker. A single suspect, or the one that was a
/// suspect before, is blamed; otherwise each of them next goes to a worker without other suspects,
/// so that another loss can be attributed.
void Dispatcher::lose(WorkerId id, const std::string& reason, const std::vector<JobKey>& suspects) {
  const Worker worker = std::move(workers_.at(id));
  workers_.erase(id);
  by_peer_.erase(worker.peer);
  by_incarnation_.erase(worker.incarnation);
  by_heard_.erase({worker.heard, id});
  out_.push_back(CloseLane{id});
  tell(WorkerLeft{id, reason});
  const std::string why =
      "worker " + std::to_string(id.value) + " on " + worker.host + " " + reason;
  const std::optional<JobKey> blamed = the_one_to_blame(suspects);
  if (!suspects.empty()) scheduler_.failed(id, now_);
  if (blamed) scheduler_.avoid(id, *blamed);
  for (const Scheduler::Held& held : scheduler_.leave(id)) {
    if (std::find(suspects.begin(), suspects.end(), held.key) == suspects.end()) {
      plan_.give_back(held.key);
      continue;
    }
    scheduler_.suspect(held.key);
    if (held.key != blamed) {
      plan_.give_back(held.key);
      continue;
    }
    charges_[worker.incarnation] = {held.key, why};
    fail(held.key, why, Failing::worker_lost);
  }
  issue();
  look_for_end();
}

std::optional<JobKey> Dispatcher::the_one_to_blame(const std::vector<JobKey>& suspects) const {
  if (suspects.size() == 1) return suspects.front();
  std::vector<JobKey> before;
  for (const JobKey key : suspects) {
    if (scheduler_.is_suspect(key)) before.push_back(key);
  }
  return before.size() == 1 ? std::optional(before.front()) : std::nullopt;
}

/// A sink that lost results is not as far as the run was, and takes no results of later jobs.
/// Whoever holds those would seem late, and be given nothing else.
void Dispatcher::restart_plan() {
  plan_.restart(std::exchange(sink_->told, {}));
  scheduler_.deal_again();
  for (const auto& [id, worker] : workers_) {
    const std::vector<Scheduler::Held> held = scheduler_.held(id);
    for (const Scheduler::Held& each : held) {
      if (plan_.wants(each.key)) continue;
      send(worker.peer, Done{each.key, attempt_number(each.attempt)});
      scheduler_.drop(id, each.key, now_);
      plan_.give_back(each.key);
    }
  }
}

void Dispatcher::lose_sink() {
  sink_.reset();
  to_workers(SinkAt{});
}

FarmProgress Dispatcher::progress() const {
  const PlanCounts& counts = plan_.counts();
  FarmProgress progress;
  progress.jobs_done = counts.done;
  progress.jobs_known = counts.ready + counts.running + counts.done + counts.failed;
  progress.cost_done = counts.cost_done;
  progress.cost_known = counts.cost_known;
  progress.stages = plan_.stages();
  progress.jobs_running = counts.running;
  progress.jobs_failed = counts.failed;
  progress.workers = static_cast<std::uint32_t>(workers_.size());
  progress.workers_lost = lost_workers_;
  progress.retries = counts.retries;
  progress.sink_present = sink_.has_value();
  if (const auto memory = scheduler_.greatest_memory()) {
    progress.jobs_too_big = plan_.ready_above(*memory);
  }
  progress.bad_hosts = scheduler_.bad_hosts();
  progress.storage_stalls = storage_stalls();
  progress.no_room = full_ || (sink_ && sink_->no_room);
  progress.other_build = other_build_;
  return progress;
}

std::vector<WorkerStatus> Dispatcher::workers() const {
  std::vector<WorkerStatus> all;
  for (const auto& [id, worker] : workers_) {
    all.push_back({id, worker.host, worker.pid, worker.capacity, scheduler_.speed(id),
                   static_cast<std::uint32_t>(scheduler_.held(id).size()), worker.beat.rss_bytes,
                   now_ - worker.heard, worker.credit - worker.sent});
  }
  return all;
}

}  // namespace meshfarm
