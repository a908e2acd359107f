// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/appearance_star.hpp"
#include "geometry/simplify/collapse_star.hpp"
#include "geometry/simplify/collapse_state.hpp"
#include "geometry/simplify/quadric.hpp"
#include "geometry/simplify/wedge_star.hpp"

namespace meshfarm {

/// Edges whose ends have more triangles than this together are refused: a hub of many thousand
/// would be walked once per edge. A hub shrinks as its rim collapses.
constexpr std::uint32_t k_max_star = CollapseStar::k_capacity;

struct CollapseLimits {
  std::uint64_t triangles = 0;  // remove no more than these
  double max_cost = 0;
};

struct Collapse {
  std::uint32_t triangles = 0;  // that it removes: 2, at a border 1; 0 if refused
  Vec3 position;
  double cost = 0;
  bool by_topology = false;  // refused to keep the topology
  double certain = -1;       // the part of the cost that is no guess; below 0: all of it
  bool opens = false;        // no vertices merge; GeneralJudge::going() are removed
};

/// The values of a merged vertex besides its position, and those of its corners.
struct MergedColumns {
  Appearance appearance{};  // if appearances are used
  std::span<const WedgeMerge> wedges;
};

/// Judges single collapses. Both ends must not have taken part in a collapse of this pass; their
/// neighbours may have.
class CollapseJudge {
 public:
  explicit CollapseJudge(const CollapseState& state) : state_(state) {}
  /// The state has moved in memory.
  void move_to(const CollapseState& state) { state_ = state; }

  /// The position and cost of the merged vertex, if the collapse keeps the topology, turns no
  /// triangle farther than Turn allows and makes none without area. The quadric is that of the
  /// triangles as they are now, each counted once.
  Collapse judge(std::uint32_t a, std::uint32_t b, const CollapseLimits& limits);
  /// What the merged vertex gets, for the last collapse judged if it was not refused.
  MergedColumns columns_of(const Collapse& collapse) const {
    return {state_.appearances.empty() ? Appearance{} : appearance_.at(collapse.position - middle_),
            wedges_.merges()};
  }

 private:
  struct Ring {
    std::array<std::uint32_t, k_max_star + 8> next;
    std::array<std::uint32_t, k_max_star + 8> prev;
    std::uint32_t size = 0;
    std::uint8_t flags = 0;
    bool border() const { return (flags & k_border) != 0; }
  };
  struct Walk {
    std::uint32_t vertex;
    std::uint32_t other;  // the edge's other end
    Corner* shared;       // where to list the triangles that have `other`
    Corner* kept;         // and those that do not
  };

  Walk walk(const Walk& walk, Ring& ring) const;
  std::uint32_t list_star(std::uint32_t a, std::uint32_t b);
  std::uint32_t common_neighbours() const;
  bool link_allows(std::uint32_t shared) const;
  void add_star(std::uint32_t shared);
  void add_appearances(std::uint32_t a, std::uint32_t b, std::uint32_t shared);
  std::span<const CornerId> ids_of(std::uint32_t vertex, std::span<CornerId> buffer) const;
  double border_weight_at(std::span<const Corner> fan, Vec3 at) const;
  void add_lines(const Ring& ring, std::uint32_t vertex, Vec3 end, std::uint32_t without);
  Vec3 line_position(std::uint32_t a, std::uint32_t b) const;
  Collapse or_at_end(const Collapse& best, std::uint32_t a, std::uint32_t b, std::uint32_t shared);
  bool is_all_of_piece(std::uint32_t a, std::uint32_t b) const;
  bool is_ribbon() const;
  bool is_longer_than_ends() const;
  bool may_turn_ribbon() const { return is_ribbon_ && state_.turns_ribbons; }
  Collapse into_line(Vec3 position, std::uint32_t shared, double max_cost);
  Collapse at_position(Vec3 position, std::uint32_t shared, double max_cost, Turn turn);
  template <typename Candidate, typename Take>
  void for_creases_of(const Ring& ring, std::uint32_t vertex, Vec3 at,
                      const Candidate& is_candidate, const Take& take) const;
  std::uint32_t next_on_line(const Ring& ring, std::uint32_t vertex, std::uint32_t without) const;
  Vec3 keep_label_areas(std::uint32_t a, std::uint32_t b, Vec3 x) const;
  Collapse best_of_positions(std::uint32_t a, std::uint32_t b, std::uint32_t shared,
                             double max_cost);
  Collapse best_with_uvs(std::uint32_t a, std::uint32_t b, std::uint32_t shared, double max_cost);

  CollapseState state_;
  Vec3 middle_;
  Ring ring_a_;
  Ring ring_b_;
  // Two places for the shared triangles, then those that a keeps, those that b keeps, one spare
  // place.
  std::array<Corner, k_max_star + 3> corners_;
  std::uint32_t kept_of_a_ = 0;
  std::uint32_t kept_ = 0;
  CollapseStar star_;
  EdgeQuadric quadric_;
  bool is_ribbon_ = false;
  AppearanceStar appearance_;
  WedgeStar wedges_;
  bool blends_uvs_ = false;  // the merged vertex is inside a chart
};

}  // namespace meshfarm
