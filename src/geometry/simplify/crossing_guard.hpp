// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/box_tree.hpp"
#include "geometry/simplify/collapse_guard.hpp"
#include "geometry/simplify/collapse_state.hpp"
#include "geometry/triangle_crossing.hpp"

namespace meshfarm {

/// Tells which collapses would make triangles cross: those after which more pairs cross than before
/// (do_cross). So triangles that cross from the start lock nothing.
class CrossingGuard {
 public:
  using Merge = CollapseGuard::Merge;
  enum class Where : std::uint8_t {
    everywhere,
    thin_walls  // only collapses whose ends are on a vertex flagged as k_thin or beside one
  };

  void move_to(const CollapseState& state) { state_ = state; }

  /// Starts with the mesh as it is. Triangles with coordinates that are not finite cross nothing.
  void start(const CollapseState& state, std::span<const Triangle> triangles, Where where);

  /// Whether the guard must be asked about a collapse, and told of it.
  bool concerns(std::uint32_t a, std::uint32_t b) const {
    return levels_.empty() || (levels_[a] | levels_[b]) != 0;
  }
  bool crosses(const Merge& merge);
  /// Must be called before the merge that was judged last is done.
  void merge();
  /// Moves all corners of a piece and returns true, unless more pairs of triangles would cross than
  /// before.
  bool moves(std::span<const std::uint32_t> vertices, std::span<const Vec3> places);
  /// Some of the vertex's triangles have moved to copies of it: the vertices from `first_copy` on.
  void split(std::uint32_t vertex, std::uint32_t first_copy);

 private:
  std::vector<Triangle> chosen(std::span<const Triangle> triangles);
  Box box_of(const Triangle& t) const;
  CrossingTriangle triangle_of(const Triangle& t) const;
  Box box_round(const Merge& merge) const;
  bool vanishes(const Triangle& t) const;
  void begin_list();
  void list(const Merge& merge);
  bool goes_on(const Triangle& t, Vec3 way) const;
  std::size_t count_before() const;
  std::size_t count(const std::vector<CrossingTriangle>& star, std::size_t enough) const;

  CollapseState state_;
  std::vector<Triangle> triangles_;  // by slot; gone if two corners are equal
  BoxTree boxes_;
  /// How near each vertex is to a thin wall, if only these count: 4 on one, 3 within one edge, 2
  /// within two, 1 if it is a corner of some other triangle in a slot.
  std::vector<std::uint8_t> levels_;

  // For the merge being judged:
  Merge merge_;
  std::vector<std::uint32_t> touching_;
  std::vector<std::uint32_t> star_;    // slots of the triangles at its ends
  std::vector<std::uint32_t> others_;  // slots of the triangles around them
  std::vector<std::uint32_t> listed_;  // of each vertex, the last list_ with it in the star
  std::uint32_t list_ = 0;
  std::vector<CrossingTriangle> fresh_;
};

}  // namespace meshfarm
