// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The farm on virtual time: the same Dispatcher, WorkerCores and SinkCore that the processes run,
// in one thread, over a simulated network, storage and hosts. Each seed gives one history.
//
// Not simulated, so only tests of the processes cover:
// - sockets: connecting, keys, strangers, garbage, other versions of the protocol; a message is one
//   event, and the ventilator's inbox is never left unread;
// - files: a result is a name, whole or damaged; the journal is never torn, a new one never begun;
//   what a job reads or writes bit by bit, and what the sink inspects in a result;
// - the sink's one disk thread: here checks, its own jobs and the output do not wait for each
//   other, and no two checks share a sync or the patience with storage;
// - a worker's threads, memory and processor time; a worker whose job hangs is killed at once, and
//   reads for the sink do not wait for each other;
// - a run's end: the ventilator's last word does not say that the output was made, earlier
//   addresses stay, and a ventilator without a sink finds the output a minute after its own start,
//   not after the sink's last word;
// - whoever starts the processes: they come again by themselves.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/schedule.hpp>
#include <meshfarm/farm/when_full.hpp>
#include <meshfarm/simulation/simulated_faults.hpp>

namespace meshfarm {

/// The cost of a job.
struct SimulatedWork {
  double compute_s = 0;  // on a worker of speed 1
  std::uint64_t read_bytes = 0;
  std::uint64_t write_bytes = 0;
  Extent extent = {};  // of the bytes read
};

struct SimulatedWorker {
  /// Which run it is told to serve: any, the first or the other one, or, as a worker of a pool, one
  /// that has work, chosen anew at each start.
  enum class Serves : std::uint8_t { any, first, other, pool };

  double speed = 1;
  std::uint32_t host = 0;  // workers of a host are cut off together
  SimulatedTime start{0};
  std::uint32_t threads = 1;
  std::uint64_t memory = 0;       // bytes; 0: no limit
  double told_speed = 0;          // the speed it reports; 0: the true one
  std::uint64_t memory_pool = 0;  // shared with those of its host that tell the same; 0: its own
  Serves serves = Serves::any;
};

/// A message takes `delay`, plus up to `jitter`.
struct SimulatedNetwork {
  SimulatedTime delay{1000};
  SimulatedTime jitter{20'000};
};

/// A file takes `delay`, then its bytes pass one after another over the server's link, which all
/// hosts share, and over the host's own. 0: no limit. A host reads bytes of an extent again without
/// that cost if they are among the last cache_bytes that it read and wrote. (Real NFS clients cache
/// what was read, but not what was written and renamed.)
struct SimulatedStorage {
  SimulatedTime delay{2000};
  double server_bytes_per_s = 0;
  double host_bytes_per_s = 0;
  std::uint64_t cache_bytes = 0;  // per host
};

/// Time of the central processes per message and per result: the limit of a large farm.
struct SimulatedCentre {
  SimulatedTime per_message{0};  // the ventilator
  SimulatedTime per_result{0};   // the sink: check the file, and its share of a journal sync
  bool eager = false;            // the ventilator ticks after each message, like the real one
};

struct SimulationOptions {
  std::uint64_t seed = 1;
  std::vector<SimulatedWorker> workers;
  SimulatedNetwork network;
  SimulatedStorage storage;
  SimulatedCentre centre;
  SimulatedFaults faults;
  FarmTime heartbeat{1000};
  std::uint32_t max_attempts = 3;
  WhenFull when_full = WhenFull::wait;
  SchedulerOptions schedule = {};
  std::uint32_t buffer = 16;      // of each worker
  double triangles_per_s = 1000;  // speed reported by a worker of speed 1
  /// The simulation must end by then.
  SimulatedTime limit{std::chrono::minutes(20)};
  std::function<SimulatedWork(const Job&)> work;  // empty: the job's cost in milliseconds
  bool through_wire = false;                      // encode and decode each message
  JobSource other;               // another run of the same stage at the same time; empty: none
  SimulatedTime other_start{0};  // when its ventilator starts
};

/// An accepted attempt.
struct SimulatedJob {
  JobKey key;
  std::uint32_t worker = 0;  // index of SimulationOptions::workers
  SimulatedTime begin{0};    // computing starts, after reading
  SimulatedTime end{0};      // the file is published
  SimulatedTime accepted{0};
  JobTimes times;
};

struct SimulationResult {
  bool ended = false;   // the simulation ended in time
  std::string broken;   // the first broken invariant, if any
  std::string failure;  // of the last run; empty: everything was done
  std::vector<AcceptedJob> outputs;
  std::string other_failure;  // the same for the other run
  std::vector<AcceptedJob> other_outputs;
  std::vector<SimulatedJob> jobs;  // in order of acceptance
  SimulatedTime first_push{0};     // when the first job was sent
  SimulatedTime last_accept{0};    // when the last result was accepted
  SimulatedTime last_verified{0};  // of those accepted by their size; 0: none was
  SimulatedTime time{0};           // end of the simulation
  std::uint64_t events = 0;
  std::uint64_t pushes = 0;  // jobs issued
  double server_busy_s = 0;  // the storage server's link
  std::uint64_t trace_hash = 0;
  std::set<std::string> banned_hosts;  // "host3": hosts that got no more jobs at some time
  std::uint32_t runs = 0;  // after a failed run the user starts again, while there are faults
};

/// Simulates the farm from its start until all processes have ended.
SimulationResult simulate_farm(const JobSource& source, const SimulationOptions& options);

}  // namespace meshfarm
