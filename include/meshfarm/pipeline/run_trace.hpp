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

/// Writes the events of a run to the stage's log folder (see report/trace.hpp). Its failures do not
/// affect the run.
class RunTrace {
 public:
  /// `head`: what is known before the run; the rest is filled in.
  RunTrace(const Stage& stage, TraceHead head) : stage_(stage), head_(std::move(head)) {}

  /// From now on the ventilator reports to this trace, which must outlive the ventilator.
  void follow(VentilatorOptions& options);
  /// Writes the end of the run; empty: all was done.
  void end(const std::string& failure);

 private:
  void event(const FarmEvent& event, FarmTime at);
  void state(const FarmProgress& progress, const std::vector<WorkerStatus>& workers, FarmTime at);
  void add(const TraceLine& line);

  const Stage& stage_;
  TraceHead head_;
  double last_s_ = 0;
  std::chrono::steady_clock::time_point begin_;  // of the run: its first event
  std::unique_ptr<LineLog> log_;
};

/// Publishes a run's summary in the stage's log folder. A failure is only logged.
void publish_summary(const Stage& stage, const RunSummary& summary);

/// The newest trace of a stage, or that of `epoch` if given. Throws DataError if there is none.
Trace read_newest_trace(const Stage& stage, std::optional<std::uint32_t> epoch = std::nullopt);
/// The same with the jobs of all epochs of its run: a ventilator that was killed leaves a trace of
/// its own. The numbering of workers continues from epoch to epoch.
Trace read_traced_run(const Stage& stage);
/// The times in the newest summary of a run; nothing if there is none.
std::optional<RunTimes> read_run_times(const Stage& stage, std::uint64_t run);
/// Whether a sink has written the run's output, but no ventilator has since ended the run, because
/// the one that the sink served was killed. An output made in a run that is over does not count.
bool output_was_made(const Stage& stage, std::uint64_t run);

}  // namespace meshfarm
