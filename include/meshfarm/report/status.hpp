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
  /// By the clock that the trace's head has its time of, as those of the hosts may differ: the file
  /// server's. Nothing: it cannot be told.
  std::optional<double> now_unix_s;
  bool no_room = false;  // on the stage: its ventilator cannot write that it waits
};

std::string render(const StageStatus& status, Format format);
/// Whether the run goes on and its ventilator has not written for some seconds, or may not have.
bool is_silent(const StageStatus& status);
/// Whether there is nothing more to watch: the last run has said its last word.
bool is_over(const StageStatus& status);

}  // namespace meshfarm
