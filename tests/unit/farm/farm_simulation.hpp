// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/farm/worker_core.hpp>

#include "farm_fixture.hpp"

namespace meshfarm::test {

/// How bad the simulated world is: chances per message or per job, until `faults_end`.
struct Faults {
  double lose = 0;          // a message, on any channel
  double crash = 0;         // the worker, at a job
  double fail = 0;          // a job
  double damaged = 0;       // a result's file
  double sink_crash = 0;    // per tick
  double vent_crash = 0;    // per tick
  double pause = 0;         // per tick of a worker: it hangs for a while, as under SIGSTOP
  std::string poison = {};  // the job with these parameters kills every worker that begins it
  FarmTime faults_end{60'000};
};

/// Ventilator, workers and sink as their state machines, on virtual time and an unreliable network.
/// One seed gives one history.
class FarmSimulation {
 public:
  FarmSimulation(JobSource source, int workers, Faults faults, std::uint64_t seed)
      : source_(std::move(source)), faults_(faults), random_(seed), workers_(workers) {
    at(FarmTime(0), [this] { start_ventilator(); });
    at(FarmTime(pick(2000)), [this] { start_sink(); });
    for (int i = 0; i < workers; ++i) {
      at(FarmTime(pick(3000)), [this, i] { start_worker(i); });
    }
  }

  /// Runs until all have left, or the time is up. False if something still lives by then.
  bool run(FarmTime limit) {
    while (!events_.empty() && now_ <= limit && broken.empty()) {
      auto node = events_.extract(events_.begin());
      now_ = node.key().first;
      ++events;
      node.mapped()();
      check_invariants();
    }
    return !vent_ && !sink_ && outputs.has_value();
  }

  std::optional<std::vector<AcceptedJob>> outputs;
  std::optional<std::string> failure;  // the ventilator's last word
  std::uint64_t events = 0;
  int outputs_made = 0;
  std::map<JobKey, int> journalled;
  std::string broken;  // the invariant that was, if any
  FarmTime now() const { return now_; }
  std::uint64_t history = 0;  // a hash of all that was done

 private:
  struct Worker {
    std::unique_ptr<WorkerCore> core;
    std::uint64_t life = 0;  // counts starts: what was meant for an earlier one is lost
    std::uint64_t incarnation = 0;
    PeerId peer;
    std::string address;
    std::string lane;
    std::string sink;
    FarmTime paused_until{0};
  };
  struct Sink {
    std::unique_ptr<SinkCore> core;
    std::string here;
    PeerId peer;
    std::string address;
  };
  static constexpr std::uint32_t k_buffer = 3;

  std::uint64_t pick(std::uint64_t below) { return random_() % below; }
  bool chance(double p) {
    const double dice = static_cast<double>(random_() >> 11) * 0x1p-53;
    return now_ < faults_.faults_end && dice < p;
  }
  void at(FarmTime delay, std::function<void()> event) {
    events_.emplace(std::pair(now_ + delay, sequence_++), std::move(event));
  }
  /// Delivers in order on each channel, or never.
  void transmit(const std::string& channel, std::function<void()> deliver) {
    if (chance(faults_.lose)) return;
    FarmTime& last = channels_[channel];
    last = std::max(last, now_ + FarmTime(1 + pick(20)));
    events_.emplace(std::pair(last, sequence_++), std::move(deliver));
  }
  static Message wire(const Message& message) { return decode(encode(message)); }
  void note(std::uint64_t what) { history = (history ^ what) * 0x100000001b3ULL; }

  // --- ventilator
  void start_ventilator() {
    ++epoch_;
    endpoints_.push_back({epoch_, 7, "v" + std::to_string(epoch_), "host", 1});
    vent_.emplace(Plan(source_, 5), DispatcherOptions{7, epoch_, FarmTime(1000)});
    credits_.clear();
    tick_ventilator(epoch_);
  }
  void tick_ventilator(std::uint32_t epoch) {
    if (!vent_ || epoch != epoch_) return;
    if (chance(faults_.vent_crash)) {
      vent_.reset();
      at(FarmTime(pick(8000)), [this] { start_ventilator(); });
      return;
    }
    vent_do(vent_->tick(now_));
    at(FarmTime(100), [this, epoch] { tick_ventilator(epoch); });
  }
  void to_ventilator(const PeerId& peer, const std::string& address, const Message& message) {
    transmit(peer + ">" + address, [=, this] {
      if (!vent_ || address != "v" + std::to_string(epoch_)) return;
      if (const auto* credit = std::get_if<Credit>(&message)) {
        auto& known = credits_[credit->worker];
        known = std::max(known, credit->up_to);
      }
      vent_do(vent_->on_message(peer, wire(message), now_));
    });
  }
  void vent_do(const Actions& actions) {
    for (const Action& action : actions) {
      if (!vent_) return;
      std::visit([this](const auto& each) { vent_act(each); }, action);
    }
  }
  void vent_act(const SendTo& each) {
    note(each.message.index());
    transmit(each.peer + "<", [this, each] {
      if (sink_ && sink_->peer == each.peer) sink_do(sink_->core->on_control(each.message, now_));
      const auto found = peers_.find(each.peer);
      if (found == peers_.end()) return;
      if (Worker& worker = workers_[found->second]; worker.core && worker.peer == each.peer) {
        const auto life = worker.life;
        awake(found->second, life, [this, each, id = found->second] {
          if (workers_[id].peer == each.peer) {
            worker_do(id, workers_[id].core->on_control(wire(each.message), now_));
          }
        });
      }
    });
  }
  std::string lane_name(WorkerId id) {
    return "lane" + std::to_string(epoch_) + "." + std::to_string(id.value);
  }
  void vent_act(const OpenLane& each) {
    if (chance(faults_.lose)) return vent_do(vent_->lane_failed(each.worker, "no port is free"));
    vent_do(vent_->lane_opened(each.worker, lane_name(each.worker)));
  }
  void vent_act(const CloseLane& each) { closed_.insert(lane_name(each.worker)); }
  void vent_act(const PushJob& each) {
    CHECK(each.assignment.lane_seq <= credits_[each.worker]);  // never beyond the credit
    CHECK(pushed_
              .insert({each.assignment.epoch, key_of(each.assignment.job).value,
                       each.assignment.attempt})
              .second);  // an attempt number is used once
    note(key_of(each.assignment.job).value);
    const std::string lane = lane_name(each.worker);
    transmit(lane, [this, each, lane] {
      if (closed_.contains(lane)) return;
      for (std::size_t i = 0; i < workers_.size(); ++i) {
        if (!workers_[i].core || workers_[i].lane != lane) continue;
        awake(i, workers_[i].life, [this, each, lane, i] {
          if (workers_[i].lane != lane) return;
          worker_do(i, workers_[i].core->on_lane(wire(each.assignment), now_));
        });
        return;
      }
    });
  }
  void vent_act(const Finish& each) {
    failure = each.failure;
    vent_.reset();
    endpoints_.push_back({++epoch_, 7, "", "host", 1});
  }

  // --- workers
  void start_worker(std::size_t id) {
    if (failure) return;
    Worker& worker = workers_[id];
    ++worker.life;
    worker.incarnation = random_() | 1;
    worker.core = std::make_unique<WorkerCore>(
        MemberOptions{Role::worker, 0, worker.incarnation, 1, "host", "", FarmTime(600'000)},
        WorkerLimits{.buffer = k_buffer});
    tick_worker(id, worker.life);
  }
  void awake(std::size_t id, std::uint64_t life, std::function<void()> event) {
    Worker& worker = workers_[id];
    if (!worker.core || worker.life != life) return;
    if (worker.paused_until <= now_) return event();
    at(worker.paused_until - now_, [=, this] { awake(id, life, event); });
  }
  void tick_worker(std::size_t id, std::uint64_t life) {
    Worker& worker = workers_[id];
    if (!worker.core || worker.life != life) return;
    if (chance(faults_.pause)) worker.paused_until = now_ + FarmTime(pick(10'000));
    awake(id, life, [this, id] { worker_do(id, workers_[id].core->tick({}, now_)); });
    at(FarmTime(100), [this, id, life] { tick_worker(id, life); });
  }
  void worker_do(std::size_t id, const WorkerActions& actions) {
    const auto life = workers_[id].life;
    for (const WorkerAction& action : actions) {
      if (!workers_[id].core || workers_[id].life != life) return;
      std::visit([&](const auto& each) { worker_act(id, each); }, action);
    }
    const Worker& worker = workers_[id];
    if (worker.core && worker.core->waiting() > k_buffer) broken = "a worker holds too much";
  }
  void worker_act(std::size_t id, const Look&) {
    worker_do(id, workers_[id].core->found(endpoints_, now_));
  }
  void worker_act(std::size_t id, const Dial& each) {
    Worker& worker = workers_[id];
    peers_.erase(worker.peer);
    worker.peer = "w" + std::to_string(random_());
    worker.address = each.address;
    peers_[worker.peer] = id;
  }
  void worker_act(std::size_t id, const HangUp&) {
    workers_[id].address.clear();
    workers_[id].peer.clear();
    workers_[id].lane.clear();
  }
  void worker_act(std::size_t id, const Say& each) {
    to_ventilator(workers_[id].peer, workers_[id].address, each.message);
  }
  void worker_act(std::size_t id, const ConnectLane& each) { workers_[id].lane = each.address; }
  void worker_act(std::size_t id, const ConnectSink& each) { workers_[id].sink = each.address; }
  void worker_act(std::size_t id, const SendResult& each) {
    const std::string sink = workers_[id].sink;
    transmit(workers_[id].peer + sink, [this, each, sink] {
      if (sink_ && sink_->here == sink) sink_do(sink_->core->on_result(wire(each.result)));
    });
  }
  void worker_act(std::size_t id, const Begin& each) {
    const auto life = workers_[id].life;
    if (chance(faults_.crash) || each.job.parameters == faults_.poison) {
      at(FarmTime(0), [this, id, life] { crash(id, life); });
      return;
    }
    const auto outcome = outcome_of(each, workers_[id].incarnation);
    at(FarmTime(1 + pick(1500)), [this, id, life, slot = each.slot, outcome] {
      awake(id, life, [this, id, slot, outcome] {
        worker_do(id, workers_[id].core->finished(slot, outcome, now_));
      });
    });
  }
  std::variant<JobOutput, JobFailure> outcome_of(const Begin& begin, std::uint64_t incarnation) {
    if (chance(faults_.fail)) return JobFailure{"no luck", FailureKind::attempt};
    JobOutput output;
    output.file.name = to_string(ResultName{key_of(begin.job).value, begin.attempt, incarnation});
    output.file.size = chance(faults_.damaged) ? 0 : 1;
    output.summary = reversed(begin.job.parameters);
    return output;
  }
  void worker_act(std::size_t, const GiveUp&) {}  // a job that does not listen ends all the same
  void worker_act(std::size_t id, const Leave& each) {
    if (each.abort) return crash(id, workers_[id].life);
    CHECK(each.incomplete == "");
    workers_[id].core.reset();
  }
  void crash(std::size_t id, std::uint64_t life) {
    if (!workers_[id].core || workers_[id].life != life) return;
    peers_.erase(workers_[id].peer);
    const auto next_life = workers_[id].life;
    workers_[id] = {};
    workers_[id].life = next_life;
    at(FarmTime(pick(5000)), [this, id] { start_worker(id); });
  }

  // --- sink
  void start_sink() {
    if (failure) return;
    sink_.emplace();
    sink_->here = "s" + std::to_string(++sinks_);
    sink_->core = std::make_unique<SinkCore>(
        MemberOptions{Role::sink, 7, random_() | 1, 1, "host", sink_->here, FarmTime(600'000)},
        source_, journal_);
    tick_sink(sinks_);
  }
  void tick_sink(std::uint64_t life) {
    if (!sink_ || life != sinks_) return;
    if (chance(faults_.sink_crash)) {
      sink_.reset();
      at(FarmTime(pick(8000)), [this] { start_sink(); });
      return;
    }
    sink_do(sink_->core->tick(now_));
    at(FarmTime(100), [this, life] { tick_sink(life); });
  }
  void sink_do(const SinkActions& actions) {
    const auto life = sinks_;
    for (const SinkAction& action : actions) {
      if (!sink_ || life != sinks_) return;
      std::visit([this](const auto& each) { sink_act(each); }, action);
    }
  }
  void sink_act(const Look&) { sink_do(sink_->core->found(endpoints_, now_)); }
  void sink_act(const Dial& each) {
    sink_->peer = "s" + std::to_string(random_());
    sink_->address = each.address;
  }
  void sink_act(const HangUp&) { sink_->peer.clear(); }
  void sink_act(const Say& each) { to_ventilator(sink_->peer, sink_->address, each.message); }
  void sink_act(const Check& each) {
    at(FarmTime(pick(50)), [this, each, life = sinks_] {
      if (!sink_ || life != sinks_) return;
      const bool whole = each.output.file.size == 1;
      if (whole && !each.from_journal) {
        journal_[each.key] = each.output;
        CHECK(++journalled[each.key] == 1);  // accepted once, whatever happens
      }
      sink_do(sink_->core->checked(each, whole ? "" : "the file is damaged"));
    });
  }
  void sink_act(const MakeOutput&) {
    at(FarmTime(pick(5000)), [this, life = sinks_] {
      if (!sink_ || life != sinks_) return;
      const auto made = sink_->core->rounds().outputs();
      outputs.emplace(made.begin(), made.end());
      ++outputs_made;
      sink_do(sink_->core->completed("", now_));
    });
  }
  void sink_act(const SinkLeaves& each) {
    const bool as_it_should = failure.value_or("").empty();
    CHECK((each.why == SinkLeaves::Why::complete) == as_it_should);
    sink_.reset();
  }

  void check_invariants() {
    if (!vent_) return;
    const PlanCounts& counts = vent_->plan().counts();
    // More are held than run only while a restarted plan does not want the held ones yet.
    if (vent_->holding() < counts.running) broken = "a job runs that nobody holds";
  }

  JobSource source_;
  Faults faults_;
  std::mt19937_64 random_;
  FarmTime now_{0};
  std::uint64_t sequence_ = 0;
  std::map<std::pair<FarmTime, std::uint64_t>, std::function<void()>> events_;
  std::map<std::string, FarmTime> channels_;
  std::vector<Endpoint> endpoints_;
  std::uint32_t epoch_ = 0;
  std::optional<Dispatcher> vent_;
  std::map<WorkerId, std::uint64_t> credits_;
  std::set<std::tuple<std::uint32_t, std::uint64_t, std::uint32_t>> pushed_;
  std::set<std::string> closed_;
  std::vector<Worker> workers_;
  std::map<PeerId, std::size_t> peers_;
  std::optional<Sink> sink_;
  std::uint64_t sinks_ = 0;
  std::map<JobKey, JobOutput> journal_;
};

}  // namespace meshfarm::test
