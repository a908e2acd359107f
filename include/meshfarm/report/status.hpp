// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/report/trace.hpp>

namespace meshfarm {

/// The output of `status` for a stage, from its newest trace and summary.
struct StageStatus {
  std::string stage;
  Manifest manifest;
  std::optional<Trace> trace;     // none: no run has begun
  std::optional<RunTimes> times;  // of the trace's run; none: it is not over
  /// By the same clock as the time in the trace's head, since hosts' clocks may differ: the file
  /// server's. Nothing: unknown.
  std::optional<double> now_unix_s;
  bool no_room = false;  // on the stage: its ventilator cannot write that it waits
  std::optional<std::uint64_t> free_bytes;  // of the stage's file system
};

/// A worker in the newest state, with its other data in the trace.
struct WorkerFacts {
  TraceJoined joined;
  TraceState::Worker state;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
};

/// The content of a status, derived from the trace. Without a run only the first fields are set.
struct StatusFacts {
  std::string stage;
  std::string input;
  std::uint64_t triangles = 0;
  std::uint64_t parts = 0;
  double cut_s = 0;
  std::optional<std::uint64_t> free_bytes;

  bool has_run = false;
  TraceHead head;
  std::string phase;   // in words
  bool over = false;   // the run has ended
  bool works = false;  // workers are working as far as is known: rate and ETA are meaningful
  bool warns = false;  // somebody may have to act
  TraceState state;
  double age_s = 0;   // since the trace's last line; 0: unknown, or the run has ended
  double rate = 0;    // triangles per second, from recently completed jobs
  double eta_s = -1;  // until all jobs known so far are done; below 0: unknown
  double elapsed_s = 0;
  std::vector<WorkerFacts> workers;
  std::uint64_t workers_left = 0;
  std::optional<RunTimes> times;

  // For repeated looks:
  double looked_s = 0;  // since the stage was last looked at
  std::string problem;  // why it could not be looked at since
};

StatusFacts facts_of(const StageStatus& status);
/// The same facts `seconds` later, with nothing new to see.
StatusFacts grown_older(StatusFacts facts, double seconds, const std::string& problem);

std::string render(const StatusFacts& facts, Format format);
inline std::string render(const StageStatus& status, Format format) {
  return render(facts_of(status), format);
}
/// Whether the run goes on and its ventilator has not (or may not have) written for some seconds.
bool is_silent(const StageStatus& status);
/// Whether there is nothing more to watch: the last run has ended.
bool is_over(const StageStatus& status);

}  // namespace meshfarm
