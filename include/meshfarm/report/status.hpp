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

/// What `status` tells of a stage, as its newest trace and summary have it.
struct StageStatus {
  std::string stage;
  Manifest manifest;
  std::optional<Trace> trace;     // none: no run began
  std::optional<RunTimes> times;  // of the trace's run; none: it is not over
  /// By the clock that the trace's head has its time of, as those of the hosts may differ: the file
  /// server's. Nothing: it cannot be told.
  std::optional<double> now_unix_s;
  bool no_room = false;  // on the stage: its ventilator cannot write that it waits
  std::optional<std::uint64_t> free_bytes;  // of the stage's file system
};

/// A worker of the newest state, with what else the trace has of it.
struct WorkerFacts {
  TraceJoined joined;
  TraceState::Worker state;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
};

/// What a status says, derived from the trace. Without a run only what comes first is there.
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
  bool over = false;   // the run has said its last word
  bool works = false;  // workers are at it as far as is known: a rate and an end mean something
  bool warns = false;  // somebody may have to do something
  TraceState state;
  double age_s = 0;   // since the last word of the trace; 0: it cannot be told, or that was the end
  double rate = 0;    // triangles a second, by the jobs that ended lately
  double eta_s = -1;  // until all jobs that are known of are done; below 0: not known
  double elapsed_s = 0;
  std::vector<WorkerFacts> workers;
  std::uint64_t workers_left = 0;
  std::optional<RunTimes> times;

  // Of who looks again and again:
  double looked_s = 0;  // since the stage was last looked at
  std::string problem;  // why it was not since
};

StatusFacts facts_of(const StageStatus& status);
/// The same as if it were looked at `seconds` later, and there were nothing new to see.
StatusFacts grown_older(StatusFacts facts, double seconds, const std::string& problem);

std::string render(const StatusFacts& facts, Format format);
inline std::string render(const StageStatus& status, Format format) {
  return render(facts_of(status), format);
}
/// Whether the run goes on and its ventilator has not written for some seconds, or may not have.
bool is_silent(const StageStatus& status);
/// Whether there is nothing more to watch: the last run has said its last word.
bool is_over(const StageStatus& status);

}  // namespace meshfarm
