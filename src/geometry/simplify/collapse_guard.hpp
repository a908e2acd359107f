// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/surface_bound.hpp>

#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/surface_probe.hpp"

namespace meshfarm {

/// Refuses collapses that would move a surface farther from another one than a bound allows, in
/// either direction. Each point of the other surface is held by a vertex near it, with a triangle
/// within the bound; its long sides are checked by the triangles near their ends. Points of new
/// triangles are looked up on the other surface.
class CollapseGuard {
 public:
  struct Merge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;  // becomes a
    Vec3 position;
    /// Triangles that go although they have only one of the ends, by their other two vertices.
    std::span<const std::pair<std::uint32_t, std::uint32_t>> vanishing;
  };

  explicit CollapseGuard(const SurfaceBound& bound) : bound_(bound), probe_(bound) {}
  void move_to(const CollapseState& state) { state_ = state; }

  /// Assigns the points to vertices. Points that are too far at the start must not get farther.
  void start(const CollapseState& state, const Mesh& mesh);

  bool allows(const Merge& merge);
  /// Must be called before the merge that was allowed last is done.
  void merge();
  /// Some of the vertex's triangles have moved to copies of it: the vertices from `first_copy` on.
  void split(std::uint32_t vertex, std::uint32_t first_copy);

 private:
  static constexpr std::uint32_t k_no_point = UINT32_MAX;

  struct Held {
    Vec3 point;
    float limit;              // squared: how far it may be, or was at the start
    float share;              // SurfacePoint::share
    std::uint32_t source;     // the triangle of the other surface
    std::uint32_t following;  // next point held by the same vertex
    // The triangle near the point, starting at the vertex that holds it; it may have changed since.
    std::uint32_t owner, next, prev;
    std::uint32_t number;   // of the bound's points
    bool is_dense = false;  // SurfacePoint::is_dense
  };
  struct Place {
    std::uint32_t point;
    std::uint32_t owner, next, prev;
    std::uint32_t following;  // next place on the same triangle of the star
    std::uint32_t facet;      // index of that triangle, if it is in the star
  };
  struct Nearest {
    double squared = HUGE_VAL;
    Triangle triangle{};
    std::uint32_t facet = 0;  // index in the star, if it is there
  };

  void hold(std::uint32_t point, const Triangle& triangle);
  Triangle nearest_of_copies(Vec3 point, std::uint32_t vertex, std::uint32_t first_copy) const;
  void forget_triangles(std::uint32_t owner, std::uint32_t vertex);
  Place place_on(std::uint32_t point, const Triangle& triangle) const;
  void list_star(const Merge& merge);
  bool is_end(std::uint32_t vertex) const { return vertex == merge_.a || vertex == merge_.b; }
  bool is_changed(const Held& held) const;
  std::size_t facet_of(std::uint32_t owner, const Held& held) const;
  std::uint32_t nearest_of_ring(Vec3 point) const;
  bool fails_again(std::uint32_t vertex);
  bool place_all();
  bool place_bag(std::uint32_t vertex, bool all);
  bool place(std::uint32_t owner, std::uint32_t point);
  void look_at_star(Vec3 point, std::size_t first, double enough, double most,
                    Nearest& nearest) const;
  void look_round(std::uint32_t around, Vec3 point, Nearest& nearest) const;
  void look_round_star(Vec3 point, Nearest& nearest) const;
  bool are_sides_near();
  bool is_side_near(const Place& place, std::uint32_t across);
  bool is_side_near(const Held& from, const Held& to, const Triangle& at_end,
                    std::size_t first) const;
  bool was_near_star(Vec3 point, double most) const;
  double squared_to(Vec3 point, const Triangle& triangle) const;
  bool is_cell_near(const Held& held, std::size_t first) const;
  void to_front(std::uint32_t vertex, std::uint32_t before, std::uint32_t point);
  bool is_star_near();
  std::uint32_t& memo();
  std::uint32_t signature() const;

  const SurfaceBound& bound_;
  CollapseState state_;
  std::vector<Held> held_;
  std::vector<std::uint32_t> held_of_;    // for each of the bound's points
  std::vector<std::uint32_t> bag_;        // the first point that a vertex holds
  std::vector<std::uint8_t> has_failed_;  // a vertex's first point has been too far before
  std::vector<std::uint32_t> moves_;      // how often each vertex moved
  std::vector<std::uint32_t> memo_;       // signatures of refused collapses

  // For the merge being judged:
  Merge merge_;
  std::vector<Corner> star_;  // the triangles that it makes
  std::vector<std::uint32_t> ring_;
  std::vector<Place> places_;
  std::vector<std::uint32_t> place_of_;  // of each held point: the last place tried
  std::vector<std::uint32_t> on_facet_;  // the first place on each triangle of the star
  std::vector<Vec3> feet_;
  SurfaceProbe probe_;
};

}  // namespace meshfarm
