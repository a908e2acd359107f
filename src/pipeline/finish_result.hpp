// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct FinishResultOptions {
  unsigned threads = 0;  // 0: one per core
  std::function<void(std::string_view phase, double done, std::uint64_t triangles)> progress;
  std::function<void()> check_stop;  // throws to stop
};

/// The mesh of a run, and its summary.
struct FinishedResult {
  Mesh mesh;
  RunSummary summary;
};

/// Reads the chosen rungs, stitches them in the order of the parts, finishes to the target, and
/// measures the error. Throws what check_stop throws.
FinishedResult finish_result(const Stage& stage, const Manifest& manifest, const RunOptions& run,
                             const ChosenRungs& chosen, const FinishResultOptions& options);

}  // namespace meshfarm
