// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>
#include <meshfarm/report/trace.hpp>
#include <meshfarm/staging/line_log.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/ventilator.hpp>

namespace meshfarm {

/// Writes what happens in a run to the stage's log folder (see report/trace.hpp). Whatever becomes
/// of that, the run goes on.
class RunTrace {
 public:
  /// `head`: what is known before the run; the rest of it is filled in.
  RunTrace(const Stage& stage, TraceHead head) : stage_(stage), head_(std::move(head)) {}

  /// From now on the ventilator tells this trace. It must outlive the ventilator.
  void follow(VentilatorOptions& options);
  /// The run's last word; empty: all was done.
  void end(const std::string& failure);

 private:
  void event(const FarmEvent& event, FarmTime at);
  void state(const FarmProgress& progress, const std::vector<WorkerStatus>& workers, FarmTime at);
  void add(const TraceLine& line);

  const Stage& stage_;
  TraceHead head_;
  double last_s_ = 0;
  std::chrono::steady_clock::time_point begin_;  // of the run, by its first event
  std::unique_ptr<LineLog> log_;
};

/// Publishes a run's summary in the stage's log folder. A failure is only logged.
void publish_summary(const Stage& stage, const RunSummary& summary);

/// The newest trace of a stage; the one of `epoch` if that is given. Throws DataError if there is
/// none.
Trace read_newest_trace(const Stage& stage, std::optional<std::uint32_t> epoch = std::nullopt);
/// The same with the jobs of all epochs of its run: a ventilator that was killed leaves a trace of
/// its own. Workers are numbered on from epoch to epoch.
Trace read_traced_run(const Stage& stage);
/// The times of the newest summary of a run; nothing if there is none.
std::optional<RunTimes> read_run_times(const Stage& stage, std::uint64_t run);
/// Whether a sink has made the run's output, and no ventilator has said since that this was the end
/// of the run: the one that the sink served was killed. An output made in a run that is over is
/// another's.
bool output_was_made(const Stage& stage, std::uint64_t run);

}  // namespace meshfarm
