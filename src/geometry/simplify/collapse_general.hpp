// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/fans.hpp"
#include "geometry/simplify/surroundings.hpp"

namespace meshfarm {

/// The outcome of a collapse that CollapseJudge cannot judge.
struct GeneralCollapse {
  Collapse collapse;  // its triangles are 0 if refused
  /// It pinches off a handle or a strip, closes a hole, or removes a piece.
  bool changes_topology = false;
};

/// Judges collapses on any complex of triangles: at vertices whose triangles are not a single fan,
/// and collapses that change the topology. Edges that do not have exactly two triangles are
/// singular: they are lines, along which their vertices merge.
class GeneralJudge {
 public:
  /// Target must be the identity: the adjacency is kept up to date. Without `any_topology`,
  /// collapses that change the topology will be refused, so their cost need not be right.
  GeneralJudge(const CollapseState& state, bool any_topology)
      : state_(state), any_topology_(any_topology) {}
  void move_to(const CollapseState& state) { state_ = state; }
  /// Whether closed pieces may become sheets before they go.
  void let_open() { may_open_ = true; }
  bool may_open() const { return may_open_; }

  /// Neither end may be fixed.
  GeneralCollapse judge(std::uint32_t a, std::uint32_t b, std::uint64_t most_triangles);

  // For the last collapse judged:

  /// Kept triangles that the collapse makes equal to another, by their other two vertices.
  std::span<const std::pair<std::uint32_t, std::uint32_t>> vanishing() const { return vanishing_; }
  /// If it opens a closed piece: the triangles that go.
  std::span<const Triangle> going() const { return going_; }
  /// If it ends a piece: vertices of it. Every edge between two of them would end it at this cost.
  std::span<const std::uint32_t> ends_of_piece() const { return ends_of_piece_; }
  /// Vertices other than the merged one whose fans change.
  std::span<const std::uint32_t> changed() const { return changed_; }
  /// What the merged vertex gets, if the collapse was not refused.
  MergedColumns columns_of(const Collapse& collapse) const {
    return {state_.appearances.empty() ? Appearance{} : appearance_.at(collapse.position - middle_),
            wedges_.merges()};
  }

 private:
  struct End {
    std::uint32_t vertex = 0;
    std::vector<std::uint32_t> neighbours;  // ascending
    std::vector<std::uint32_t> singular;    // of these, those across singular edges
    std::vector<std::uint32_t> open;        // of these, those across edges that have one triangle
    std::size_t crowded = 0;                // edges that have more than two triangles
    int rank = 0;

    /// As where three walls cross. With 4, a head with small folds has 4 % more error.
    bool is_in_cells() const { return crowded >= 6; }
  };
  struct Kept {
    Corner corner;
    bool at_b = false;
    bool vanishes = false;
  };

  void list_end(std::uint32_t vertex, End& end);
  void list_triangles();
  void find_vanishing();
  bool changes_topology();
  bool is_crowded(std::uint32_t vertex, const End& end) const;
  bool crowds_an_edge();
  /// Whether sheets cross all around the edge.
  bool is_of_cells() const {
    return a_.rank == 2 && b_.rank == 2 && (a_.is_in_cells() || b_.is_in_cells());
  }
  void add_star(Vec3 half);
  void add_appearances();
  void add_lines(const End& end, const End& other, Vec3 at);
  Collapse best_of_positions();
  Collapse into_line(Vec3 position) const;
  Collapse or_beside_line(const Collapse& on_line) const;
  Collapse turned_far(std::span<const Vec3, 2> ends) const;
  Collapse best_with_uvs();
  bool may_go_to(Vec3 x) const;
  Collapse at_position(Vec3 position, Turn turn) const;
  Collapse at_best(Turn turn) const;
  double cost_of_past(Vec3 x) const;
  bool is_lost(std::uint32_t vertex) const;
  void list_lost();
  double squared_to_cover(Vec3 from) const;
  void list_points_of_sheet();
  double cost_of_lost();
  void add_cost_of_tips(Collapse& collapse);
  Collapse end_of_piece(std::uint64_t most_triangles);
  bool is_closed_piece() const;
  bool is_tetrahedron() const;
  void list_ends_of_piece();
  Collapse opening();
  double cost_of_opening(std::span<const Triangle> going, std::span<const Triangle> standing) const;

  CollapseState state_;
  bool any_topology_;
  bool may_open_ = false;
  End a_;
  End b_;
  std::vector<Corner> shared_;  // as corners of a
  std::vector<Kept> kept_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> vanishing_;
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint32_t> ends_;
  std::vector<Corner> merged_;
  std::vector<std::uint32_t> joined_;  // of merged_, those at one edge
  FanSplitter splitter_;
  bool changes_ = false;
  std::uint32_t removed_ = 0;
  std::uint32_t staying_ = 0;
  Vec3 middle_;
  Vec3 half_;                        // from there to b
  std::vector<std::uint32_t> lost_;  // ascending
  std::vector<std::uint32_t> ends_of_piece_;
  std::vector<Triangle> triangles_of_piece_;
  std::vector<Triangle> going_;  // of these, if it is opened
  Surroundings surroundings_;
  std::vector<Vec3> points_of_sheet_;
  CollapseStar star_;
  EdgeQuadric quadric_;
  AppearanceStar appearance_;
  WedgeStar wedges_;
};

}  // namespace meshfarm
