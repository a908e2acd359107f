// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/divide/weld_counts.hpp>
#include <meshfarm/geometry/sweep_order.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>

namespace meshfarm {

/// The maximum memory to sort a slab and encode its stream, per triangle.
inline constexpr std::uint64_t k_slab_bytes_per_triangle = 72;
/// The same if vertices may have appearances (two copies and the encoded ones), and if triangles
/// have columns, which are sorted with them.
constexpr std::uint64_t slab_bytes_per_triangle(bool has_appearances, const ColumnSet& columns) {
  return k_slab_bytes_per_triangle + (has_appearances ? 2 * sizeof(Appearance) : 0) +
         (columns.any() ? sizeof(Triangle) + 3 * columns.bytes() : 0);
}

/// A slab in sweep order.
struct SortedSlab : WeldCounts {
  StreamMesh stream;
  std::uint32_t boundary_vertices = 0;
  std::uint64_t merged_vertices = 0;  // coincident vertices that were merged
};

/// Sorts vertices, welds coincident ones (they are neighbours then), drops degenerate triangles and
/// unused vertices, and sorts triangles by their smallest vertex, then by the others. With exact
/// welding the result does not depend on the order of the slab.
SortedSlab sort_slab(MeshShare raw, const Sorting& sorting);

/// The approximate number of triangles in a sample of a stream.
std::uint64_t sample_size(std::uint64_t stream_triangles);

/// A piece of a stream, across its whole slab, as a part whose outer vertices are locked. It has
/// about sample_size() triangles; `number` decides its position along the second axis.
Part sample_slab(const StreamMesh& stream, const SweepOrder& order, std::uint32_t number);

}  // namespace meshfarm
