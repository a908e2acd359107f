// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>

#include <meshfarm/report/clean_report.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// finished_runs: also the results of complete runs, which another run with the same target would
/// reuse. leftovers: only what nobody can need any more.
enum class CleanWhat { leftovers, finished_runs };

struct CleanOptions {
  CleanWhat what = CleanWhat::finished_runs;
  bool dry_run = false;
  /// Files that nobody is known to need are removed at this age, by the clock of the stage's
  /// server.
  std::chrono::seconds least_age{600};
  /// The same for temporary files while there is an incomplete run.
  std::chrono::seconds least_age_in_run{3600};
};

/// Removes what no run needs, neither a run in progress nor one that the same command would resume.
/// The cut, traces, summaries, keys and foreign files stay. Throws DataError if somebody is
/// cleaning already.
CleanReport clean_stage(const Stage& stage, const CleanOptions& options);

/// Held by a sink as long as it works, so that its stage's results are not removed meanwhile. Waits
/// for a cleaning in progress to end.
class SinkPresence {
 public:
  explicit SinkPresence(const Stage& stage);

 private:
  std::unique_ptr<Claim> claim_;  // null if it could not be written
};

}  // namespace meshfarm
