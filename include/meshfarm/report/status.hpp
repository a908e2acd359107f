// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
  /// Since the trace was last written, by one clock, the file server's: the clocks of the hosts may
  /// differ. Nothing: it cannot be told.
  std::optional<double> age_s;
  bool no_room = false;  // on the stage: its ventilator cannot write that it waits
};

std::string render(const StageStatus& status, Format format);
/// Whether the run goes on and its ventilator has not written for some seconds, or may not have.
bool is_silent(const StageStatus& status);
/// Whether there is nothing more to watch: the last run has said its last word.
bool is_over(const StageStatus& status);

}  // namespace meshfarm
