// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>

namespace meshfarm {

struct AssembleOptions {
  MeshOutput output;
  unsigned threads = 0;  // to measure with, 0: one a core; nothing depends on it
  std::function<void(std::string_view phase, double done, std::uint64_t triangles)> progress;
  const std::atomic<bool>* stop = nullptr;
};

/// The end of a run, once every job of make_job_source is accepted: reads the chosen rungs,
/// stitches them in the order of the parts, finishes to the target, and writes the result. Throws
/// IncompleteError when stopped: nothing is written then.
RunSummary assemble(const Stage& stage, const Manifest& manifest, const RunOptions& run,
                    std::span<const AcceptedJob> accepted, const AssembleOptions& options);

}  // namespace meshfarm
