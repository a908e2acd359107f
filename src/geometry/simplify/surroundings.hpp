// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/point_index.hpp>
#include <meshfarm/geometry/vec.hpp>

#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {

/// A mesh that loses triangles: its vertices as they are now.
struct ShrinkingMesh {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> target;  // the vertex that a vertex has become
  const Adjacency* adjacency = nullptr;
};

/// Tells how far a piece, or its tip, is from the rest of a mesh: what is lost with it. Vertices
/// stand for the surface, at their positions when first asked.
class Surroundings {
 public:
  struct Lost {
    Vec3 middle;
    std::span<const Vec3> points;            // where to search from; empty: from the middle
    std::span<const std::uint32_t> without;  // its vertices, ascending
  };
  /// The squared distance, a mean over all points, to the nearest triangle that is left and has
  /// none of the vertices, as far as corners and points inside large triangles tell; infinite if
  /// there is none.
  double squared_distance(const ShrinkingMesh& mesh, const Lost& lost);

 private:
  struct Nearest {
    double squared = HUGE_VAL;
    std::uint32_t vertex = 0;  // of the triangle
  };
  /// What was found for the points of a piece: it holds while it is there and as far away.
  struct Found {
    double sum = HUGE_VAL;
    std::array<std::uint32_t, 3> vertices{};
  };
  static bool is_remembered(const Lost& lost, std::size_t points);
  Found& found_for(const ShrinkingMesh& mesh, const Lost& lost);
  void search(const ShrinkingMesh& mesh, Vec3 from, std::span<const std::uint32_t> without,
              Nearest& nearest);
  void list_vertices(const ShrinkingMesh& mesh);
  void add_points_inside(const ShrinkingMesh& mesh, std::vector<Vec3>& points);
  void drop_what_is_gone(const ShrinkingMesh& mesh);

  std::vector<std::uint32_t> vertices_;  // of the points
  std::optional<PointIndex> index_;
  std::vector<Found> found_;       // by the piece's lowest vertex
  std::vector<Nearest> nearest_;   // to the points so far
  std::uint64_t passed_over_ = 0;  // points of pieces that are gone, since the index was made
};

}  // namespace meshfarm
