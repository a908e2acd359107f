// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/geometry/simplify.hpp>

namespace meshfarm {

/// At this many triangles from a seam, parts that were simplified to a bound are as simple as they
/// can be.
inline constexpr int k_bounded_rings = 5;

struct BoundedFinishOptions {
  double max_error = 0;
  /// Where above 0: the result is proven to be within this distance of the input, if the mesh was
  /// before.
  double certified_error = 0;
  PositionType positions = PositionType::float32;
  LineOptions lines;
  unsigned threads = 0;
  std::function<void(std::uint64_t triangles_left)> progress;
};

/// The surroundings of seams.
struct SeamMesh {
  Mesh mesh;
  std::uint32_t locked = 0;  // the first vertices; they neither move nor go
  /// How many of these, from the first on, stay even if no triangle uses them.
  std::uint32_t kept = 0;
  /// Triangles with vertices only from first_unsure up to end_unsure, which are locked, may be
  /// changed by others meanwhile: they prove nothing.
  std::uint32_t first_unsure = 0;
  std::uint32_t end_unsure = 0;
};

struct BoundedFinish {
  Mesh mesh;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
};

/// The cells in which the input affects what may change.
NearCells cells_round_changes(const SeamMesh& seams, const BoundedFinishOptions& options);

/// Adds the triangles that are near, with vertices of their own.
void add_near(std::span<const Vec3> positions, std::span<const Triangle> triangles,
              const NearCells& near, Mesh& mesh);

/// Simplifies as far as the bound allows. `input`: all of it that is near what may change; if it is
/// empty, the mesh is only cleaned. The locked vertices that are not left out come first in the
/// result, in their order.
BoundedFinish simplify_seams(SeamMesh seams, Mesh input, const BoundedFinishOptions& options);

}  // namespace meshfarm
