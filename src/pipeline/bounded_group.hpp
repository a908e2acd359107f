// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>

#include "pipeline/joined_strips.hpp"
#include "pipeline/seam_bound.hpp"

namespace meshfarm {

/// A group of the seams' surroundings as it is taken from the joined strips.
struct GroupToBound {
  Mesh mesh;
  std::uint32_t shared = 0;  // the first vertices, which stay
  /// For each vertex of the strips, its number in the mesh, or k_left_out.
  std::vector<std::uint32_t> number;
};

/// Simplifies a group as far as SeamParameters::bound allows: measured against the input of its
/// parts, with the rest of their pieces beside it. Only what is near is held in memory. Throws as
/// reading does.
BoundedFinish simplify_group(GroupToBound group, const JoinedStrips& strips,
                             const SeamParameters& parameters, const JobContext& context);

}  // namespace meshfarm
