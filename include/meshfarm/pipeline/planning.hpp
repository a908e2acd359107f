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

/// A farmed job of the past, on a worker of speed 1.
struct PlannedJob {
  /// Neighbours among the jobs.
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
  std::vector<Range> needs = {};  // if none are given: all jobs of less depth
  std::string stage = {};
  std::string kind = {};         // Job::kind
  bool left_to_readers = false;  // Job::left_to_readers
  Extent extent = {};            // Job::extent
};

/// The jobs of a trace, sorted by depth. Speed 1 is that of the trace's worker that did most work
/// in the time it computed. A job that was traced twice (an epoch before did it, too) counts once.
std::vector<PlannedJob> planned_jobs(const Trace& trace);
/// The same, where the jobs of the depth with the most work, those that simplify parts, are so many
/// instead.
std::vector<PlannedJob> as_parts(std::span<const PlannedJob> jobs, std::uint64_t count);
/// So many of at least one job, drawn at random from the depth with the most work: of streams the
/// sweep, not the samples before it (the paper, 3.4.2).
std::vector<PlannedJob> drawn(std::span<const PlannedJob> jobs, std::uint64_t count,
                              std::uint64_t seed);

/// So many workers of one speed.
struct WorkerGroup {
  std::uint64_t count = 0;
  double speed = 1;
};

/// What the farm of the future is like.
struct PlannedFarm {
  std::vector<WorkerGroup> groups;
  Schedule schedule = Schedule::dynamic;
  double off = 0;           // the speeds are not as told: each is up to this share slower or faster
  double delay_s = 100e-6;  // of a message
  double file_s = 1e-3;     // of a file operation, besides its bytes
  double server_bytes_per_s = 1.25e9;  // of the NFS server, shared: 10 Gbit/s
  double link_bytes_per_s = 1.25e9;    // of each host
  double cache_bytes = 4e9;            // in which each host keeps what it has read
  double message_s = 10e-6;            // of the ventilator, for each message
  double result_s = 100e-6;            // of the sink, for each result
};

struct PlannedRun {
  double farm_s = 0;        // from the first job given out to the last result verified
  double accepted_s = 0;    // to the last result accepted
  double ideal_s = 0;       // all work over all speed
  double work_s = 0;        // all work, on one worker of speed 1
  double storage_s = 0;     // that the server's link is busy
  double storage_busy = 0;  // the same as a share of the time
};

/// Simulates the farm on virtual time, with the real processes' own logic. Throws Error if that
/// does not come to its end.
PlannedRun simulate_run(std::span<const PlannedJob> jobs, const PlannedFarm& farm);

/// Jobs of one depth, on some farm.
struct PlannedStage {
  std::string name;  // of those with most work
  std::uint64_t jobs = 0;
  double takes_s = 0;    // from the end of those before it to its own
  double ideal_s = 0;    // its work over all speed
  double longest_s = 0;  // of its jobs, on a worker of speed 1
  double storage_s = 0;  // what goes over the server's link
};
/// What takes how long, in order. Runs the simulation once a stage.
std::vector<PlannedStage> simulate_stages(std::span<const PlannedJob> jobs,
                                          const PlannedFarm& farm);

}  // namespace meshfarm
