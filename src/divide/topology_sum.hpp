// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/boundary_file.hpp>

#include "divide/boundary_numbers.hpp"
#include "divide/mesh_shares.hpp"
#include "divide/shared_vertices.hpp"

namespace meshfarm {

/// A slab to measure, with its boundary vertices in the order of their numbers.
struct MeasuredSlab {
  Mesh mesh;
  std::vector<std::uint32_t> shared;
};

/// Sums up the topology of the slabs and of what lies between them. The triangles between slabs are
/// visited slab by slab: each belongs to the lowest slab that it touches, and so does each of its
/// sides between two slabs.
class TopologySum {
 public:
  TopologySum(const MeshShares& shares, const std::filesystem::path& folder, std::uint32_t slabs)
      : shares_(shares), vertices_(folder, slabs), pieces_(slabs) {}

  /// May be called from several threads; once for each slab.
  void add(std::uint32_t slab, const MeasuredSlab& measured, const BoundaryNumbers& numbers);
  /// Call this once, after all slabs.
  Topology finish();

 private:
  /// A side between two slabs: vertices by their slabs and their numbers there.
  using SideEnds = std::array<BoundaryCorner, 2>;

  void add(const Topology& piece);
  BoundaryCorner corner(SharePlace vertex);
  void add_seam(std::uint32_t slab);
  void add_between(const SeamTriangle& t);
  void add_sides(std::uint32_t slab, const SeamTriangle& t);
  void count_sides();
  void join(const SeamTriangle& t);
  std::uint64_t piece_of(SharePlace vertex);

  const MeshShares& shares_;
  SharedVertices vertices_;
  std::vector<std::uint64_t> pieces_;      // at each slab's boundary; then the sum before it
  std::vector<std::uint64_t> parent_;      // of pieces that triangles between slabs join
  std::vector<BoundaryTriangle> between_;  // of the current slab
  std::vector<SideEnds> crossing_;         // of the current slab
  Topology sum_;
  std::mutex mutex_;
};

}  // namespace meshfarm
