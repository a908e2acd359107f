// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>

#include <meshfarm/report/clean_report.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// finished_runs: also the results of runs that are complete, which another run of the same target
/// would find. leftovers: only what nobody can need any more.
enum class CleanWhat { leftovers, finished_runs };

struct CleanOptions {
  CleanWhat what = CleanWhat::finished_runs;
  bool dry_run = false;
  /// What nobody is known to want is removed once it is so old, by the clock of the stage's server.
  std::chrono::seconds least_age{600};
  /// The same of temporary files while there is a run that is not complete.
  std::chrono::seconds least_age_in_run{3600};
};

/// Removes what no run needs: not one that goes on, and not one that the same command would take up
/// again. The cut, traces, summaries, keys and whatever is not ours stay. Throws DataError if
/// somebody cleans already.
CleanReport clean_stage(const Stage& stage, const CleanOptions& options);

/// Held by a sink as long as it works: its stage's results are not cleaned away meanwhile. Waits
/// for the end of a cleaning.
class SinkPresence {
 public:
  explicit SinkPresence(const Stage& stage);

 private:
  std::unique_ptr<Claim> claim_;  // none where it could not be written
};

}  // namespace meshfarm
