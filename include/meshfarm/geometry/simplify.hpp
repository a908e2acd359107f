// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <meshfarm/geometry/mesh.hpp>
#include <span>
#include <vector>

namespace meshfarm {

struct SimplifyOptions {
  /// The first n vertices neither move nor go: they keep their indices 0..n-1.
  std::uint32_t locked_vertices = 0;
  /// Positions of new vertices are rounded to this before they are checked.
  PositionType positions = PositionType::float64;
  /// Where not empty: one flag a vertex; only edges that touch a flagged vertex may collapse
  /// (the seam-only pass of Xiong et al. 2008, 3.3). A vertex merged from a flagged one is flagged.
  std::vector<std::uint8_t> seam;
};

/// How far to go: whichever limit is met first.
struct SimplifyGoal {
  /// Stop at this many triangles; never fewer.
  std::uint64_t triangles = 0;
  /// Collapse no edge that costs more. A cost is an area times a squared distance: the sum over the
  /// triangles of the collapsed edge of area x squared distance of the new vertex to their planes.
  double max_cost = std::numeric_limits<double>::infinity();
};

/// Iterative edge collapse by quadric error (Garland & Heckbert 1997) in passes without a heap;
/// quadrics are memoryless (Lindstrom & Turk 1999): made anew from the current mesh at each pass.
///
/// The input may be dirty: degenerate and duplicate triangles are dropped and counted; non-manifold
/// edges and vertices are locked. Topology is kept, no triangle flips, none becomes degenerate.
/// Deterministic: same mesh, options and goals, same bytes.
class Simplifier {
 public:
  Simplifier(Mesh mesh, SimplifyOptions options);
  ~Simplifier();
  Simplifier(Simplifier&&) noexcept;

  /// Collapses until the goal is met or nothing that is allowed is left. May be called again with
  /// a farther goal. `progress` (may be empty) is told the triangles left after each pass, and
  /// stops the work by returning false.
  void reduce(const SimplifyGoal& goal,
              const std::function<bool(std::uint64_t triangles_left)>& progress = {});

  /// The mesh as it is now: no unused vertices (but the locked ones), original order kept.
  const Mesh& mesh() const;
  std::uint64_t triangles() const { return mesh().triangles.size(); }
  /// Triangles none of whose vertices is locked: what a part can still be asked to give.
  std::uint64_t free_triangles() const;
  /// The greatest cost paid so far.
  double max_cost() const;
  /// The greatest cost that the last pass was allowed to pay: with rank-limited passes the level
  /// that the mesh has reached.
  double pass_cost() const;
  std::uint64_t dropped_degenerate() const;
  std::uint64_t dropped_duplicate() const;
  /// Flags of the vertices of mesh() that are, or were merged from, seam vertices.
  std::span<const std::uint8_t> seam() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
