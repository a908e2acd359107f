// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The dispatcher's second half: jobs, from issue to the end of the run.
#include <algorithm>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Attempt numbers continue from epoch to epoch, so that a worker that outlives a ventilator never
/// publishes two results under one name.
constexpr std::uint32_t k_attempts_per_epoch = 1000;
/// Pause between probes of a full stage; it doubles each time.
constexpr FarmTime k_first_probe{1000};
constexpr FarmTime k_longest_pause{5000};
/// If the stage is full again and again, the pauses grow up to this.
constexpr FarmTime k_longest_relapse{60'000};
constexpr std::uint64_t k_least_probe = std::uint64_t{64} << 10;
constexpr std::uint64_t k_greatest_probe = std::uint64_t{64} << 20;
/// How long a second reader may take, and how long the sink keeps trying what others can read.
constexpr FarmTime k_second_reading{120'000};
constexpr FarmTime k_sinks_patience{90'000};
/// A reader that took this long had trouble, too.
constexpr FarmTime k_troubled_reading{10'000};
constexpr FarmTime k_about_the_same_time{30'000};

}  // namespace

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
  sink_->unverified = accept.unverified;
  greatest_output_ = std::max(greatest_output_, accept.output.file.size);
  if (!sink_->ready) {
    sink_->told[accept.key] = accept.output;
  } else {
    const bool fresh = plan_.accept(accept.key, accept.output);
    if (fresh && !full_) relapses_ = 0;
    const bool is_done = accept.worker.value != 0 || accept.times.cpu_us > 0;  // not from a journal
    if (fresh && options_.tell && is_done) {
      tell(JobAccepted{accept.worker, accept.key, plan_.job(accept.key), plan_.place(accept.key),
                       accept.output.file.size, accept.times});
    }
  }
  blame_who_could_not_read(accept);
  if (scheduler_.known(accept.worker)) {
    scheduler_.did(accept.worker, accept.key, accept.times.compute_ms, now_);
  }
  settle(accept.key, accept.worker);
  issue();
  look_for_end();
}

void Dispatcher::on(const PeerId& peer, const Reject& reject) {
  if (!from_sink(peer, reject.epoch)) return;
  tell(AttemptFailed{reject.worker, reject.key, reject.failure.reason});
  switch (reject.failure.kind) {
    case FailureKind::for_good:
      fail(reject.key, reject.failure.reason, Failing::for_good);
      settle(reject.key, reject.worker);
      break;
    case FailureKind::no_space:
      // A worker may have kept it from an earlier run: there may be room by now.
      if (!holds(reject.worker, reject.key, reject.attempt)) {
        reject_attempt(reject, Blame::nobody);
        break;
      }
      if (options_.when_full == WhenFull::wait) {
        stage_is_full(reject);
        break;
      }
      return finish("the stage has no room left (" + reject.failure.reason + ")" +
                        std::string(k_after_making_room),
                    true);
    case FailureKind::attempt:
      if (!doubt(reject)) reject_attempt(reject, Blame::host);
      break;
    case FailureKind::unread:
      if (!doubt(reject)) reject_attempt(reject, Blame::nobody);
      break;
    case FailureKind::no_input:
    case FailureKind::damaged_input:
      reject_attempt(reject, Blame::host_if_others_can);
      break;
  }
  issue();
  look_for_end();
}

bool Dispatcher::holds(WorkerId id, JobKey key, std::uint32_t attempt) const {
  if (!scheduler_.known(id)) return false;
  const auto& held = scheduler_.held(id);
  return std::any_of(held.begin(), held.end(), [&](const Scheduler::Held& each) {
    return each.key == key && attempt_number(each.attempt) == attempt;
  });
}

/// Only the worker's current attempt counts.
void Dispatcher::reject_attempt(const Reject& reject, Blame blame) {
  const auto reporter = workers_.find(reject.worker);
  if (reporter == workers_.end()) return;
  send(reporter->second.peer, Done{reject.key, reject.attempt});
  if (!holds(reject.worker, reject.key, reject.attempt)) return;
  drop(reject.worker, reject.key);
  const std::string& host = reporter->second.host;
  if (blame == Blame::host) scheduler_.host_failed(host, now_);
  if (blame != Blame::nobody) scheduler_.avoid(reject.worker, reject.key);
  if (blame == Blame::host_if_others_can) unread_on_[reject.key].push_back({host, now_});
  const FailureKind kind = reject.failure.kind;
  const bool unread = kind == FailureKind::unread || kind == FailureKind::no_input;
  fail(reject.key, reject.failure.reason, unread ? Failing::unread : Failing::attempt);
}

// --- who can read what

/// Asks another worker to read what the sink cannot. False if there is nobody to ask, or nothing to
/// read: then the sink's word is final.
bool Dispatcher::doubt(const Reject& reject) {
  if (reject.file.name.empty() || !holds(reject.worker, reject.key, reject.attempt)) return false;
  const auto known = doubts_.find({reject.key, reject.attempt});
  if (known != doubts_.end()) {
    // The worker repeats its result, and the sink tries again.
    Doubt& doubt = known->second;
    const bool tried_long =
        reject.failure.kind == FailureKind::unread || now_ - doubt.since >= k_sinks_patience;
    if (!doubt.whole || !tried_long) return true;
    doubts_.erase(known);
    reject_attempt({reject.epoch,
                    reject.worker,
                    reject.attempt,
                    reject.key,
                    {reject.failure.reason, FailureKind::unread},
                    {}},
                   Blame::nobody);
    return true;
  }
  const auto reader = second_reader(workers_.at(reject.worker));
  if (!reader) return false;
  doubts_[{reject.key, reject.attempt}] = {reject, *reader, now_, false};
  send(workers_.at(*reader).peer, TryRead{reject.key, reject.attempt, reject.file});
  return true;
}

/// A worker of a host that neither wrote the file nor failed to read it.
std::optional<WorkerId> Dispatcher::second_reader(const Worker& reporter) const {
  for (const auto& [id, worker] : workers_) {
    const bool other = worker.host != reporter.host && worker.host != sink_->host;
    if (other && !worker.lane.empty()) return id;
  }
  return std::nullopt;
}

void Dispatcher::on(const PeerId& peer, const TriedRead& tried) {
  if (worker_at(peer, tried.worker, tried.epoch) == nullptr) return;
  const auto found = doubts_.find({tried.key, tried.attempt});
  if (found == doubts_.end() || found->second.reader != tried.worker) return;
  Doubt& doubt = found->second;
  doubt.whole = tried.whole;
  // The sink may have looked too early: it gets the result again, and keeps trying for a while.
  if (tried.whole && doubt.reject.failure.kind != FailureKind::unread) return;
  const Reject reject = doubt.reject;
  doubts_.erase(found);
  reject_attempt(reject, tried.whole ? Blame::nobody : Blame::host);
  issue();
  look_for_end();
}

/// Without an answer from the second reader the job is done again, and nobody is to blame.
void Dispatcher::look_at_doubts() {
  std::vector<Reject> unsettled;
  std::erase_if(doubts_, [&](const auto& each) {
    const Doubt& doubt = each.second;
    const Reject& reject = doubt.reject;
    if (!holds(reject.worker, reject.key, reject.attempt)) return true;
    const bool waits = !doubt.whole && workers_.contains(doubt.reader);
    if ((waits || doubt.whole) && now_ - doubt.since < k_second_reading) return false;
    unsettled.push_back(reject);
    return true;
  });
  for (Reject& reject : unsettled) {
    reject.failure.kind = FailureKind::unread;
    reject_attempt(reject, Blame::nobody);
  }
  if (!unsettled.empty()) look_for_end();
}

/// The job was done: a host that could not read its input is blamed if a worker of another host
/// read it without trouble at about the same time.
void Dispatcher::blame_who_could_not_read(const Accept& accept) {
  const auto found = unread_on_.find(accept.key);
  const auto worker = workers_.find(accept.worker);
  if (found == unread_on_.end() || worker == workers_.end()) return;
  const JobTimes& times = accept.times;
  if (FarmTime(times.read_ms) >= k_troubled_reading) return;
  const FarmTime read = now_ - FarmTime(times.wait_ms) - FarmTime(times.compute_ms);
  for (const Unread& unread : found->second) {
    const bool at_once = read - unread.at < k_about_the_same_time;
    if (at_once && unread.host != worker->second.host) scheduler_.host_failed(unread.host, now_);
  }
}

void Dispatcher::on(const PeerId& peer, const Ready& ready) {
  if (!from_sink(peer, ready.epoch)) return;
  sink_->unverified = ready.unverified;
  if (sink_->ready) return look_for_end();
  if (ready.accepted != sink_->told.size()) {
    send(peer, Refused{Refusal::stranger, "some of what was accepted got lost; say hello again"});
    return lose_sink();
  }
  sink_->ready = true;
  restart_plan();
  over_ = over_ && plan_.complete();  // a sink that lost results needs workers again
  for (const LostJob& lost : plan_.lost()) {
    send(peer, JobFailed{lost.key, clipped(lost.reasons), lost.resumable});
  }
  issue();
  look_for_end();
}

void Dispatcher::on(const PeerId& peer, const Complete& complete) {
  if (!from_sink(peer, complete.epoch) || !plan_.complete()) return;
  finish({}, false);
}

void Dispatcher::on(const PeerId& peer, const Failed& failed) {
  if (!from_sink(peer, failed.epoch)) return;
  finish("the sink could not make the output: " + failed.reason, failed.resumable);
}

// --- who does what

std::uint32_t Dispatcher::attempt_number(std::uint32_t attempt) const {
  return k_attempts_per_epoch * (options_.epoch - 1) + attempt;
}

/// The attempts made so far are no longer needed: their reporter and their holders may forget them.
void Dispatcher::settle(JobKey key, WorkerId reporter) {
  const Done done{key, attempt_number(plan_.attempts(key))};
  const auto told = workers_.find(reporter);
  if (told != workers_.end()) send(told->second.peer, done);
  for (const WorkerId holder : scheduler_.holders(key)) {
    if (holder != reporter) send(workers_.at(holder).peer, done);
    drop(holder, key);
    plan_.give_back(key);  // if the plan has it neither done nor failed: nobody runs it now
  }
  const auto state = plan_.state(key);
  if (state != JobState::done && state != JobState::failed) return;
  scheduler_.settled(key);
  unread_on_.erase(key);
}

void Dispatcher::drop(WorkerId holder, JobKey key) {
  scheduler_.drop(holder, key, now_);
}

void Dispatcher::fail(JobKey key, const std::string& reason, Failing failing) {
  const bool was_failed = plan_.state(key) == JobState::failed;
  plan_.fail_attempt(key, reason, failing);
  if (was_failed || plan_.state(key) != JobState::failed || !sink_ || !sink_->ready) return;
  const LostJob lost = plan_.lost(key);
  send(sink_->peer, JobFailed{key, clipped(lost.reasons), lost.resumable});
}

void Dispatcher::set_room(WorkerId id) {
  const Worker& worker = workers_.at(id);
  const bool may = !worker.lane.empty() && worker.credit > worker.sent;
  scheduler_.set_room(id, may ? worker.credit - worker.sent : 0);
}

/// The job becomes ready again, and nobody is to blame.
void Dispatcher::stage_is_full(const Reject& reject) {
  send(workers_.at(reject.worker).peer, Done{reject.key, reject.attempt});
  drop(reject.worker, reject.key);
  plan_.give_back(reject.key);
  if (full_) return;
  FullStage full;
  full.pause = std::min(k_first_probe * (1 << std::min(relapses_, 10U)), k_longest_relapse);
  full.next_probe = now_ + full.pause;
  full_ = full;
  ++relapses_;
}

/// With room for only one result all workers would compute in vain: the more often the stage was
/// full again, the more room is required.
void Dispatcher::look_for_room() {
  if (finished_ || !full_ || full_->probing || now_ < full_->next_probe) return;
  full_->probing = true;
  const std::uint64_t wanted = std::max(k_least_probe, greatest_output_)
                               << std::min(relapses_, 10U);
  out_.push_back(ProbeStage{std::min(wanted, k_greatest_probe)});
}

Actions Dispatcher::probed(const std::string& problem, FarmTime now) {
  now_ = std::max(now_, now);
  if (full_ && problem.empty()) full_.reset();
  if (full_) {
    full_->probing = false;
    if (full_->pause < k_longest_pause) full_->pause = std::min(2 * full_->pause, k_longest_pause);
    full_->next_probe = now_ + full_->pause;
  }
  issue();
  return take();
}

bool Dispatcher::may_issue() const {
  return !finished_ && sink_ && sink_->ready && !sink_->no_room && !full_;
}

void Dispatcher::issue() {
  while (may_issue()) {
    auto pick = scheduler_.next(plan_, now_);
    if (!pick) return;
    push(std::move(*pick));
  }
}

void Dispatcher::push(Scheduler::Pick pick) {
  Worker& worker = workers_.at(pick.worker);
  worker.pushed = now_;
  worker.unreceived_beats = 0;
  ++worker.sent;
  out_.push_back(PushJob{pick.worker, pick.job.key,
                         Assignment{options_.run, options_.epoch, worker.sent,
                                    attempt_number(pick.job.attempt), std::move(pick.job.job)}});
}

void Dispatcher::look_for_end() {
  if (finished_ || over_) return;
  if (plan_.complete()) {
    // Results that the sink takes back are made again, and need workers.
    if (!sink_ || !sink_->ready || sink_->unverified > 0) return;
    over_ = true;
    to_workers(Stop{StopReason::run_over});
  } else if (plan_.stuck()) {
    const std::vector<LostJob> all = plan_.lost();
    const bool resumable =
        std::all_of(all.begin(), all.end(), [](const LostJob& lost) { return lost.resumable; });
    finish(failed_for_good(reasons_of_lost()), resumable);
  }
}

/// A run with nothing left but jobs that fit no worker would wait for ever.
void Dispatcher::look_for_memory() {
  const PlanCounts& counts = plan_.counts();
  const bool is_at_rest = counts.ready > 0 && counts.running == 0;
  // Computed only then: it looks at all workers.
  const auto greatest = is_at_rest ? scheduler_.greatest_memory() : std::nullopt;
  const bool too_large = greatest && plan_.ready_above(*greatest) == counts.ready;
  if (!too_large) return too_large_since_.reset();
  if (!too_large_since_) too_large_since_ = now_;
  if (now_ - *too_large_since_ < options_.wait_for_memory) return;
  const auto mib = [](std::uint64_t bytes) { return std::to_string((bytes >> 20) + 1) + " MiB"; };
  std::string failure = std::to_string(counts.ready) +
                        (counts.ready == 1 ? " job needs" : " jobs need") +
                        " more memory than any worker has (" + mib(plan_.greatest_memory_ready()) +
                        ", the largest worker has " + mib(*greatest) +
                        "); what is done is kept: start a worker with more memory and run the "
                        "same command again, or cut into more --parts";
  const std::vector<std::string> reasons = reasons_of_lost();
  if (!reasons.empty()) failure += "; besides, " + failed_for_good(reasons);
  finish(failure, true);
}

std::vector<std::string> Dispatcher::reasons_of_lost() const {
  std::vector<std::string> reasons;
  for (const LostJob& lost : plan_.lost()) {
    reasons.push_back(lost.kind + " " + to_hex(lost.key.value) + ": " + lost.reasons);
  }
  return reasons;
}

void Dispatcher::finish(const std::string& failure, bool resumable) {
  over_ = true;
  to_workers(Stop{StopReason::run_over});
  // The sink was told of failed jobs already; this is for runs that end for other reasons.
  if (sink_ && !plan_.complete() && !plan_.stuck()) {
    send(sink_->peer, JobFailed{k_whole_run, clipped(failure), resumable});
  }
  if (sink_) send(sink_->peer, Stop{StopReason::run_over});
  finished_ = true;
  out_.push_back(Finish{failure, resumable});
}

void Dispatcher::to_workers(const Message& message) {
  for (const auto& [id, worker] : workers_) send(worker.peer, message);
}

}  // namespace meshfarm
