// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace meshfarm {

// The content of a trace, one struct per line; see src/report/trace.cpp for the format. Times `t`
// are in seconds since the ventilator's start, worker numbers are those of its epoch.

struct TraceHead {
  std::uint32_t epoch = 0;
  std::uint64_t run = 0;
  double unix_s = 0;  // when the ventilator started, by the file server's clock
  std::string host;   // where
  std::uint32_t heartbeat_ms = 0;
  std::string schedule;         // "dynamic", "static"
  std::uint64_t triangles = 0;  // of the input
  double cut_s = 0;
};
struct TraceJoined {
  double t = 0;
  std::uint32_t worker = 0;
  std::string host;
  std::uint32_t pid = 0;
  std::uint64_t speed = 0;   // triangles per second and thread, by benchmark
  std::uint64_t memory = 0;  // bytes
  std::uint64_t pool = 0;    // workers of its host with the same number share memory; 0: none
  std::uint32_t threads = 1;
};
struct TraceLeft {
  double t = 0;
  std::uint32_t worker = 0;
  std::string why;
};
/// Used instead of a worker's number.
inline constexpr std::uint32_t k_sink_of_trace = 0;

/// A job whose result was accepted.
struct TraceDone {
  /// Consecutive jobs of one stage.
  struct Needs {
    std::string stage;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  double t = 0;
  std::uint32_t worker = k_sink_of_trace;
  std::uint64_t job = 0;  // its key
  std::string kind;
  std::string stage;            // of the run's jobs; empty in old traces
  std::uint32_t index = 0;      // in the stage
  std::vector<Needs> needs;     // accepted before this job was possible
  std::uint32_t round = 0;      // old traces: all earlier rounds were accepted before
  std::uint64_t triangles = 0;  // estimated work
  std::uint64_t memory = 0;
  std::uint64_t read_bytes = 0;
  std::uint64_t extent = 0;        // name of bytes that others read, too; 0: none
  std::uint64_t extent_bytes = 0;  // number of those that were read
  std::uint64_t written_bytes = 0;
  std::uint32_t read_ms = 0;
  std::uint32_t wait_ms = 0;
  std::uint32_t compute_ms = 0;
  std::uint32_t write_ms = 0;
  std::uint64_t cpu_us = 0;  // of computing: the time on an otherwise idle host
};
struct TraceFailed {
  double t = 0;
  std::uint32_t worker = 0;
  std::uint64_t job = 0;
  std::string why;
};
/// The state of the farm.
struct TraceState {
  struct Worker {
    std::uint32_t worker = 0;
    std::uint32_t held = 0;    // jobs sent and not done
    std::uint32_t buffer = 0;  // additional jobs that it would hold
    double speed = 0;          // triangles per second and thread, from completed jobs
    std::uint64_t rss_bytes = 0;
    double silent_s = 0;
  };
  /// Of the jobs known so far.
  struct Stage {
    std::string stage;
    std::uint64_t jobs = 0;
    std::uint64_t done = 0;
  };
  double t = 0;
  std::uint64_t jobs_done = 0;
  std::uint64_t jobs_running = 0;
  std::uint64_t jobs_failed = 0;
  std::uint64_t jobs_known = 0;
  std::vector<Stage> stages = {};  // in order
  std::uint64_t retries = 0;
  std::uint64_t triangles_done = 0;
  std::uint64_t triangles_known = 0;
  bool sink = false;
  bool storage_stalls = false;
  bool no_room = false;  // the stage, or the result's disk, is full
  std::vector<std::string> bad_hosts;
  std::vector<Worker> workers;
};
/// The end of a run, as written by the ventilator. `failure` is empty if everything was done.
struct TraceEnd {
  double t = 0;
  std::string failure;
};
using TraceLine =
    std::variant<TraceHead, TraceJoined, TraceLeft, TraceDone, TraceFailed, TraceState, TraceEnd>;

/// One line, without its newline.
std::string to_line(const TraceLine& line);

struct Trace {
  TraceHead head;
  std::vector<TraceJoined> joined;
  std::vector<TraceLeft> left;
  std::vector<TraceDone> done;
  std::vector<TraceFailed> failed;
  std::optional<TraceState> state;  // the latest
  std::optional<TraceEnd> end;
};

/// An incomplete last line is ignored. Throws DataError naming `what`.
Trace parse_trace(std::string_view text, std::string_view what);

/// Reads a trace piece by piece while it grows.
class TraceFeed {
 public:
  /// `what`: its name, for messages.
  explicit TraceFeed(std::string what) : what_(std::move(what)) {}
  /// Adds the content of the next piece; an incomplete last line waits for its rest. Throws
  /// DataError; the trace must not be used after that.
  void add(std::string_view piece, Trace& trace);
  /// Lines so far. The first one is the head.
  std::uint64_t lines() const { return lines_; }

 private:
  void add_line(std::string_view line, Trace& trace);

  std::string what_;
  std::string rest_;
  std::uint64_t lines_ = 0;
};

}  // namespace meshfarm
