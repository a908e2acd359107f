// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/mesh_shares.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/stream_file.hpp>

#include "stream/sweep_order.hpp"

namespace meshfarm {

/// A slab in sweep order.
struct SortedSlab {
  StreamMesh stream;
  /// Numbers of boundary vertices count these alone, in sweep order.
  BoundaryNumbers boundary;
  std::uint32_t boundary_vertices = 0;
  std::uint64_t merged_vertices = 0;
  std::uint64_t dropped_degenerate = 0;
};

struct SlabOptions {
  SweepOrder order;
  Weld weld = Weld::exact;
  PositionType positions = PositionType::float32;
};

/// Sorts vertices, welds those that coincide (they are neighbours now), drops degenerate triangles
/// and unused vertices, and sorts triangles by their smallest vertex, then the others: with exact
/// welding the result does not depend on the order in which the slab came.
SortedSlab sort_slab(MeshShare raw, const SlabOptions& options);

/// A piece of the slab, right through it, as a part whose edge is locked: about `triangles` of
/// them, from a place along the second axis that `number` decides.
Part sample_slab(const SortedSlab& slab, const SweepOrder& order, std::uint64_t triangles,
                 std::uint32_t number);

}  // namespace meshfarm
