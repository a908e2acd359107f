// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/stitch/stitcher.hpp>

#include "pipeline/seam_bound.hpp"

namespace meshfarm {

/// Simplifies the surroundings of seams between parts that were simplified to a bound, as far as
/// the bound allows; what is farther from seams stays unchanged. Only the input near the seams is
/// held in memory.
BoundedFinish finish_to_bound(const Stage& stage, const Manifest& manifest, StitchedMesh stitched,
                              const BoundedFinishOptions& options);

}  // namespace meshfarm
