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
#include <meshfarm/farm/job_clock.hpp>
#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/farm/worker_core.hpp>
#include <meshfarm/simulation/simulation.hpp>

#include "simulation/dice.hpp"
#include "simulation/event_queue.hpp"
#include "simulation/simulated_network.hpp"
#include "simulation/simulated_storage.hpp"
#include "simulation/simulation_checks.hpp"

namespace meshfarm {

/// The simulated processes, each a state machine of the farm and what surrounds it in its real
/// process. Each part of this class has its own source file: ventilator, workers, sink, faults.
class SimulatedFarm {
 public:
  SimulatedFarm(const JobSource& source, const SimulationOptions& options);
  SimulationResult run();

 private:
  /// A process can be killed, restarted, stopped and continued.
  struct Process {
    std::uint32_t host = 0;
    std::uint64_t life = 0;  // counts starts and ends: events for another life are dropped
    bool alive = false;
    SimulatedTime asleep_until{0};
  };
  struct Ventilator : Process {
    std::optional<Dispatcher> core;
    std::uint32_t epoch = 0;
  };
  /// The common part of workers and sinks: their end of the control channel.
  struct Member : Process {
    std::string peer;           // name of its connection; empty: not connected
    std::uint32_t dialled = 0;  // the epoch of that connection
    SimulatedChannel to_ventilator, from_ventilator;
  };
  /// A job in one of a worker's slots.
  struct InWork {
    std::uint64_t token = 0;  // distinguishes it from earlier and later jobs of the slot
    JobKey key;
    std::uint32_t attempt = 0;
    Job job;
    SimulatedWork work;
    JobPhase phase = JobPhase::storage;
    bool reads_much = false;  // currently
    bool hangs = false;
    bool looks_for_file = false;  // its reader waits for a file that is not visible yet
    SimulatedTime begin{0};       // of computing
    JobClock clock;
  };
  struct Worker : Member {
    std::unique_ptr<WorkerCore> core;
    std::uint64_t incarnation = 0;
    std::uint64_t serves = 0;  // the run that it was told to serve; 0: any
    bool leaves = false;       // it was asked to
    std::string lane;
    std::string sink;
    std::vector<std::optional<InWork>> slots;
    std::deque<std::uint32_t> to_read;     // slots that wait to read much input
    std::uint32_t reading = 0;             // number of slots that do
    std::deque<std::uint32_t> to_compute;  // slots that wait to compute
    std::uint32_t computing = 0;           // number of threads that do
    WorkerPulse pulse;
    SimulatedChannel lane_channel, to_sink;
  };
  struct Sink : Member {
    std::unique_ptr<SinkCore> core;
    std::string here;
  };

  /// A ventilator and a sink of the stage, and the state between them.
  struct Run {
    std::uint64_t key = 0;
    const JobSource* source = nullptr;
    Ventilator ventilator;
    Sink sink;
    SimulationChecks checks;
    std::map<JobKey, JobOutput> journal;
    std::deque<Check> to_verify;                // accepted by the sink by their size
    unsigned verifying = 0;                     // number of those being read
    std::map<WorkerId, std::uint32_t> members;  // of the ventilator's epoch: whose lane it is
    SimulatedTime centre_free{0};
    SimulatedTime sink_free{0};
    SimulatedTime started{0};
    SimulatedTime sink_started{0};
    bool made_output = false;  // its sink left after making the output
    std::uint32_t starts = 0;
    bool finished = false;  // its ventilator has ended the run
    SimulatedTime finished_at{0};
    bool restarting = false;
    std::string failure;
    std::vector<AcceptedJob> outputs;
  };
  static constexpr std::uint64_t k_first_run = 7;
  static constexpr std::uint64_t k_other_run = 77;

  FarmTime farm_now() const { return std::chrono::duration_cast<FarmTime>(queue_.now()); }
  bool faulty() const { return queue_.now() < options_.faults.end; }
  bool chance(double p) { return faulty() && dice_.chance(p); }
  void note(std::uint64_t what);
  /// A message in transit, as it was decoded from the wire.
  using Letter = std::shared_ptr<const Message>;
  Letter in_envelope(Message message) const;
  SimulatedTime up_to(std::chrono::milliseconds longest);
  /// Executes the event once the process is awake, if it is still alive by then.
  template <class Event>
  void when_awake(Process& process, std::uint64_t life, const Event& event) {
    if (!process.alive || process.life != life) return;
    if (process.asleep_until <= queue_.now()) return event();
    queue_.at(process.asleep_until,
              [this, &process, life, event] { when_awake(process, life, event); });
  }
  void kill(Process& process);
  /// Executes the event after a sequential process has spent this much time on it.
  template <class Event>
  void in_its_turn(SimulatedTime& free, SimulatedTime takes, const Event& event) {
    if (takes.count() == 0) return event();
    free = std::max(free, queue_.now()) + takes;
    queue_.at(free, event);
  }
  std::string broken() const;
  static bool is_over(const Run& run);
  bool stays_behind(const Worker& worker);
  bool over() const;
  void tell_result();
  std::uint32_t index_of(const Worker& worker) const {
    return static_cast<std::uint32_t>(&worker - workers_.data());
  }

  void start_run(Run& run);
  void start_ventilator(Run& run);
  void tick_ventilator(Run& run, std::uint64_t life);
  void look_for_output(Run& run);
  void kill_ventilator(Run& run);
  void start_member(Member& member);
  void end_member(Member& member);
  void dial(Member& member, const std::string& name, const Dial& each);
  void say(Member& member, Message message);
  /// The run of that epoch's ventilator; null if it is gone, or never existed.
  Run* run_at(std::uint32_t epoch);
  void ventilator_gets(Run& run, const std::string& peer, const Letter& letter);
  void ventilator_hears(Run& run, const std::string& peer, const Message& message);
  /// Passes the message to `hear` when it arrives, if the member still has that connection then.
  template <class Hear>
  void to_member(Run& run, Member& member, Message message, const Hear& hear) {
    member.from_ventilator.from = run.ventilator.host;
    const bool buffered = chance(0.5);
    wires_.send(member.from_ventilator, SimulatedWires::Order::kept,
                [this, &run, &member, buffered, life = run.ventilator.life, peer = member.peer,
                 letter = in_envelope(std::move(message)), hear] {
                  if (buffered && run.ventilator.life != life) return;
                  when_awake(member, member.life, [&member, peer, letter, hear] {
                    if (member.peer == peer) hear(*letter);
                  });
                });
  }
  void ventilator_does(Run& run, Actions actions);
  void act(Run& run, SendTo& each);
  void act(Run& run, OpenLane& each);
  void act(Run& run, CloseLane& each);
  void act(Run& run, PushJob& each);
  void act(Run& run, ProbeStage& each);
  void act(Run& run, Finish& each);
  void act(Run&, Tell&) {}
  Worker* worker_at(const std::string& peer);
  SimulatedTime failing_ends() const;
  void run_again(Run& run);

  std::optional<std::uint64_t> run_for(SimulatedWorker::Serves serves);
  Run* run_of_sink(const std::string& address);
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
  /// Executes the event at that time, if the slot still has its current job.
  template <class Event>
  void while_in_work(Worker& worker, std::uint32_t slot, SimulatedTime time, const Event& event) {
    const std::uint64_t token = worker.slots[slot]->token;
    queue_.at(time, [this, &worker, slot, token, life = worker.life, event] {
      when_awake(worker, life, [&worker, slot, token, event] {
        if (worker.slots[slot] && worker.slots[slot]->token == token) event();
      });
    });
  }
  void read_next(Worker& worker);
  void read(Worker& worker, std::uint32_t slot);
  void end_reading(Worker& worker, InWork& in_work);
  void compute_next(Worker& worker);
  void begin_computing(Worker& worker, std::uint32_t slot);
  void compute(Worker& worker, std::uint32_t slot);
  void end_computing(Worker& worker, InWork& in_work);
  void write(Worker& worker, std::uint32_t slot);
  void finish_job(Worker& worker, std::uint32_t slot, std::variant<JobOutput, JobFailure> outcome);
  void fail_job(Worker& worker, std::uint32_t slot, const char* reason,
                FailureKind kind = FailureKind::attempt);

  void start_sink(Run& run);
  void tick_sink(Run& run, std::uint64_t life);
  void kill_sink(Run& run);
  void suffer(Run& run);
  void sink_does(Run& run, SinkActions actions);
  void sink_act(Run& run, Look& each);
  void sink_act(Run& run, Dial& each);
  void sink_act(Run& run, HangUp& each);
  void sink_act(Run& run, Say& each);
  void sink_act(Run& run, const Check& each);
  void sink_act(Run& run, const DoHere& each);
  void check_known(Run& run, const Check& each);
  void verify_next(Run& run);
  void check_by_sick_mount(Run& run, const Check& each, SimulatedTime readable);
  void sink_act(Run& run, MakeOutput& each);
  void sink_act(Run& run, SinkLeaves& each);
  void journal(Run& run, const Check& check);

  /// The stage's endpoints as a host's processes see them.
  std::vector<Endpoint> endpoints_seen(std::uint32_t host);
  void announce(std::uint64_t run, const std::string& address);
  void change_other_run();
  Run& any_run();
  void plan_faults();
  SimulatedTime some_minutes();
  SimulatedTime lost_part(JobKey key);
  void look_at_bans(const Run& run);
  /// Repeats a fault at this rate per minute, until the faults end.
  void repeat(double rate_per_minute, const std::function<void()>& fault);

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
  std::deque<Run> runs_;
  std::vector<Worker> workers_;
  std::map<JobKey, SimulatedTime> lost_parts_;
  std::unordered_map<std::string, SimulatedJob> published_;  // by the file's name
};

}  // namespace meshfarm
