// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/when_full.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/security.hpp>

namespace meshfarm {

struct SinkOptions {
  std::string bind = "127.0.0.1";
  std::uint16_t first_port = 0;  // 0: any
  std::uint16_t last_port = 0;
  SecurityOptions security;
  std::uint64_t run = 0;                       // must match the ventilator's
  std::uint32_t algorithm = 0;                 // must match, too
  std::chrono::milliseconds patience{60'000};  // how long to look for a ventilator
  WhenFull when_full = WhenFull::wait;         // of the stage, and of the output's place
  const std::atomic<bool>* stop = nullptr;
  /// Throws DataError if the source could not use this output of a job of that kind: the output is
  /// then not accepted, and the job is done again. May be empty.
  std::function<void(std::string_view kind, const JobOutput&)> inspect;
  /// Does the source's jobs that the sink does itself (Job::by_sink), from the results accepted by
  /// then; called by another thread. Throws Error: the run then fails. May be empty if there are
  /// none.
  std::function<JobOutput(const Job&, const JobContext&, std::span<const AcceptedJob>)> do_here;
};

/// Collects results: verifies each file, journals it and tells the ventilator, until every job that
/// `source` wants is accepted. Results accepted by an earlier incarnation or run are taken from the
/// journals if their files exist, and verified again while the farm works. Then calls `complete`
/// with the outputs in the order of the jobs' names, while it stays in touch with the ventilator,
/// and tells the ventilator that the run is over. Returns the epoch of the last ventilator it
/// served. Throws IncompleteError when stopped or when the ventilator is lost, DataError when jobs
/// failed for good.
std::uint32_t run_sink(const Stage& stage, const JobSource& source, const SinkOptions& options,
                       const std::function<void(std::span<const AcceptedJob>)>& complete);

}  // namespace meshfarm
