// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/stitch/stitcher.hpp>

namespace meshfarm {

struct BoundedFinishOptions {
  double max_error = 0;
  /// Where above 0: what is made is proven to be within this distance of the input, if what was
  /// stitched is.
  double certified_error = 0;
  LineOptions lines;
  unsigned threads = 0;
  std::function<void(std::uint64_t triangles_left)> progress;
};

struct BoundedFinish {
  Mesh mesh;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
};

/// Simplifies what is round the seams of parts that were simplified to a bound, as far as the bound
/// allows: what is farther from seams stays as it is. Of the input only what is near the seams is
/// held in memory.
BoundedFinish finish_to_bound(const Stage& stage, const Manifest& manifest, StitchedMesh stitched,
                              const BoundedFinishOptions& options);

}  // namespace meshfarm
