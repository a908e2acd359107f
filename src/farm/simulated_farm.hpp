// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/farm/simulation.hpp>
#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/farm/worker_core.hpp>

#include "farm/dice.hpp"
#include "farm/event_queue.hpp"
#include "farm/simulated_network.hpp"
#include "farm/simulated_storage.hpp"
#include "farm/simulation_checks.hpp"

namespace meshfarm {

/// The simulated processes, each a state machine of the farm and what stands round it in its real
/// process. The parts of this class have a source file each: ventilator, workers, sink, faults.
class SimulatedFarm {
 public:
  SimulatedFarm(const JobSource& source, const SimulationOptions& options);
  SimulationResult run();

 private:
  /// A process can be killed, started again, stopped and continued.
  struct Process {
    std::uint32_t host = 0;
    std::uint64_t life = 0;  // counts starts and ends: what was meant for another one is lost
    bool alive = false;
    SimulatedTime asleep_until{0};
  };
  struct Ventilator : Process {
    std::optional<Dispatcher> core;
    std::uint32_t epoch = 0;
  };
  /// A job in one of a worker's slots.
  struct InWork {
    std::uint64_t token = 0;  // tells it from the slot's jobs before and after
    JobKey key;
    std::uint32_t attempt = 0;
    Job job;
    SimulatedWork work;
    JobPhase phase = JobPhase::storage;
    bool hangs = false;
    bool looks_for_file = false;  // its reader waits for a file that is not to be seen yet
    SimulatedTime lap{0};         // the phase's begin
    SimulatedTime begin{0};       // of computing
    JobTimes times;
  };
  struct Worker : Process {
    std::unique_ptr<WorkerCore> core;
    std::uint64_t incarnation = 0;
    bool leaves = false;        // it was asked to
    std::string peer;           // the name of its connection; empty: hung up
    std::uint32_t dialled = 0;  // the epoch that it leads to
    std::string lane;
    std::string sink;
    std::vector<std::optional<InWork>> slots;
    std::deque<std::uint32_t> gate;  // slots that wait to compute
    std::uint32_t computing = 0;     // threads that do
    WorkerPulse pulse;
    SimulatedChannel to_ventilator, from_ventilator, lane_channel, to_sink;
  };
  struct Sink : Process {
    std::unique_ptr<SinkCore> core;
    std::string here;
    std::string peer;
    std::uint32_t dialled = 0;
    SimulatedChannel to_ventilator, from_ventilator;
  };

  FarmTime farm_now() const { return std::chrono::duration_cast<FarmTime>(queue_.now()); }
  bool faulty() const { return queue_.now() < options_.faults.end; }
  bool chance(double p) { return faulty() && dice_.chance(p); }
  void note(std::uint64_t what);
  /// A message on its way: as it comes out of the wire.
  using Letter = std::shared_ptr<const Message>;
  Letter in_envelope(Message message) const;
  SimulatedTime up_to(std::chrono::milliseconds longest);
  /// Lets it happen once the process is awake, if it still lives by then.
  template <class Event>
  void when_awake(Process& process, std::uint64_t life, const Event& event) {
    if (!process.alive || process.life != life) return;
    if (process.asleep_until <= queue_.now()) return event();
    queue_.at(process.asleep_until,
              [this, &process, life, event] { when_awake(process, life, event); });
  }
  void kill(Process& process);
  /// Lets it happen when whoever does one thing after another has had so much time for it.
  template <class Event>
  void in_its_turn(SimulatedTime& free, SimulatedTime takes, const Event& event) {
    if (takes.count() == 0) return event();
    free = std::max(free, queue_.now()) + takes;
    queue_.at(free, event);
  }
  bool over() const;
  std::uint32_t index_of(const Worker& worker) const {
    return static_cast<std::uint32_t>(&worker - workers_.data());
  }

  void start_ventilator();
  void tick_ventilator(std::uint64_t life);
  void kill_ventilator();
  void to_ventilator(const Process& sender, SimulatedChannel& channel, const std::string& peer,
                     std::uint32_t epoch, Message message);
  void ventilator_hears(const std::string& peer, const Message& message);
  void to_worker(Worker& worker, const std::string& peer, Message message);
  void to_sink(const std::string& peer, Message message);
  void ventilator_does(Actions actions);
  void act(SendTo& each);
  void act(OpenLane& each);
  void act(CloseLane& each);
  void act(PushJob& each);
  void act(ProbeStage& each);
  void act(Finish& each);
  void act(Tell&) {}
  Worker* worker_at(const std::string& peer);
  SimulatedTime failing_ends() const;
  void run_again();

  void start_worker(std::uint32_t index);
  void ask_to_leave(std::uint32_t index);
  void tick_worker(std::uint32_t index, std::uint64_t life);
  void kill_worker(std::uint32_t index);
  void worker_does(std::uint32_t index, WorkerActions actions);
  void act(std::uint32_t index, Look& each);
  void act(std::uint32_t index, Dial& each);
  void act(std::uint32_t index, HangUp& each);
  void act(std::uint32_t index, Say& each);
  void act(std::uint32_t index, ConnectLane& each);
  void act(std::uint32_t index, ConnectSink& each);
  void act(std::uint32_t index, SendResult& each);
  void act(std::uint32_t index, Begin& each);
  void act(std::uint32_t index, GiveUp& each);
  void act(std::uint32_t index, ReadForSink& each);
  void act(std::uint32_t index, Leave& each);
  void feel_pulse(Worker& worker);
  std::uint32_t lap_ms(InWork& in_work) const;
  /// Lets it happen at that time, if the slot's job of now is still there.
  template <class Event>
  void while_in_work(Worker& worker, std::uint32_t slot, SimulatedTime time, const Event& event) {
    const std::uint64_t token = worker.slots[slot]->token;
    queue_.at(time, [this, &worker, slot, token, life = worker.life, event] {
      when_awake(worker, life, [&worker, slot, token, event] {
        if (worker.slots[slot] && worker.slots[slot]->token == token) event();
      });
    });
  }
  void open_gate(Worker& worker);
  void begin_computing(Worker& worker, std::uint32_t slot);
  void compute(Worker& worker, std::uint32_t slot);
  void end_computing(Worker& worker, InWork& in_work);
  void write(Worker& worker, std::uint32_t slot);
  void finish_job(Worker& worker, std::uint32_t slot, std::variant<JobOutput, JobFailure> outcome);
  void fail_job(Worker& worker, std::uint32_t slot, const char* reason,
                FailureKind kind = FailureKind::attempt);

  void start_sink();
  void tick_sink(std::uint64_t life);
  void kill_sink();
  void sink_does(SinkActions actions);
  void sink_act(Look& each);
  void sink_act(Dial& each);
  void sink_act(HangUp& each);
  void sink_act(Say& each);
  void sink_act(const Check& each);
  void check_by_sick_mount(const Check& each, SimulatedTime readable);
  void sink_act(MakeOutput& each);
  void sink_act(SinkLeaves& each);
  void journal(const Check& check);

  /// What a host's processes see of the stage's endpoints.
  std::vector<Endpoint> endpoints_seen(std::uint32_t host);
  void announce(std::uint64_t run, const std::string& address);
  void change_other_run();
  void plan_faults();
  SimulatedTime some_minutes();
  SimulatedTime lost_part(JobKey key);
  void look_at_bans();
  /// Lets a fault happen again and again, so often a minute, until the faults end.
  void repeat(double rate_per_minute, const std::function<void()>& fault);

  const JobSource& source_;
  const SimulationOptions& options_;
  SimulationResult result_;
  Dice dice_;
  EventQueue queue_;
  std::uint32_t hosts_;
  SimulatedWires wires_;
  SimulatedFolder folder_;
  SimulationChecks checks_;
  std::vector<Endpoint> endpoints_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, SimulatedTime> seen_from_;  // host, epoch
  std::uint32_t epochs_ = 0;
  std::uint64_t dials_ = 0;
  std::uint64_t tokens_ = 0;
  Ventilator ventilator_;
  std::vector<Worker> workers_;
  Sink sink_;
  std::map<JobKey, JobOutput> journal_;
  std::map<JobKey, SimulatedTime> lost_parts_;
  std::unordered_map<std::string, SimulatedJob> published_;  // by the file's name
  std::map<WorkerId, std::uint32_t> members_;  // of the ventilator's epoch: whose lane it is
  SimulatedTime centre_free_{0};
  SimulatedTime sink_free_{0};
  SimulatedTime run_start_{0};
  bool finished_ = false;  // the last run's ventilator said its last word
  bool said_failure_ = false;
  bool restarting_ = false;
};

}  // namespace meshfarm
