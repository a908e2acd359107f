// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/schedule.hpp>
#include <meshfarm/report/trace.hpp>

namespace meshfarm {

/// A past job of the farm, as if on a worker of speed 1.
struct PlannedJob {
  /// A range of consecutive jobs.
  struct Range {
    std::size_t first = 0;
    std::size_t end = 0;
    friend auto operator<=>(const Range&, const Range&) = default;
  };
  std::uint32_t depth = 0;  // of the longest chain of jobs before it
  std::uint64_t triangles = 0;
  std::uint64_t read_bytes = 0;
  std::uint64_t written_bytes = 0;
  double compute_s = 0;
  std::vector<Range> needs = {};  // empty: all jobs of lower depth
  std::string stage = {};
  std::string kind = {};         // Job::kind
  bool left_to_readers = false;  // Job::left_to_readers
  Extent extent = {};            // Job::extent
};

/// The jobs of a trace, sorted by depth. Speed 1 is that of the trace's worker that did most work
/// in its computing time. A job traced twice (because an earlier epoch did it, too) counts once.
std::vector<PlannedJob> planned_jobs(const Trace& trace);
/// The same with `count` jobs at the depth with the most work, which are those that simplify parts.
std::vector<PlannedJob> as_parts(std::span<const PlannedJob> jobs, std::uint64_t count);
/// `count` jobs drawn at random from the depth with the most work; `jobs` must not be empty. For
/// streams that depth is the sweep, not the samples before it (the paper, 3.4.2).
std::vector<PlannedJob> drawn(std::span<const PlannedJob> jobs, std::uint64_t count,
                              std::uint64_t seed);

/// Workers of one speed.
struct WorkerGroup {
  std::uint64_t count = 0;
  double speed = 1;
};

/// The farm to simulate.
struct PlannedFarm {
  std::vector<WorkerGroup> groups;
  Schedule schedule = Schedule::dynamic;
  double off = 0;           // the speeds are inexact: each is up to this share slower or faster
  double delay_s = 100e-6;  // per message
  double file_s = 1e-3;     // per file operation, without its bytes
  double server_bytes_per_s = 1.25e9;  // of the NFS server, shared: 10 Gbit/s
  double link_bytes_per_s = 1.25e9;    // per host
  double cache_bytes = 4e9;            // each host's cache of what it has read
  double message_s = 10e-6;            // of the ventilator, per message
  double result_s = 100e-6;            // of the sink, per result
};

struct PlannedRun {
  double farm_s = 0;        // from the first job given out to the last result verified
  double accepted_s = 0;    // to the last result accepted
  double ideal_s = 0;       // all work divided by the sum of all speeds
  double work_s = 0;        // all work, on one worker of speed 1
  double storage_s = 0;     // how long the server's link is busy
  double storage_busy = 0;  // the same as a share of the time
};

/// Simulates the farm in virtual time, with the real processes' own logic. Throws Error if the
/// simulation does not end.
PlannedRun simulate_run(std::span<const PlannedJob> jobs, const PlannedFarm& farm);

/// Jobs of one depth, on a simulated farm.
struct PlannedStage {
  std::string name;  // that of the stage with most work
  std::uint64_t jobs = 0;
  double takes_s = 0;    // from the end of the previous stage to its own
  double ideal_s = 0;    // its work divided by the sum of all speeds
  double longest_s = 0;  // of its longest job, on a worker of speed 1
  double storage_s = 0;  // of transfers over the server's link
};
/// How long each stage takes, in order. Runs the simulation once per stage.
std::vector<PlannedStage> simulate_stages(std::span<const PlannedJob> jobs,
                                          const PlannedFarm& farm);

}  // namespace meshfarm
