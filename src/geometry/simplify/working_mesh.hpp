// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/simplify_clean.hpp"
#include "geometry/simplify/simplify_lines.hpp"
#include "geometry/simplify/small_pieces.hpp"

namespace meshfarm {

class CollapseQueue;

/// A mesh that is being simplified: clean, its vertices flagged, without unused vertices except the
/// locked ones. A pass merges vertices, each at most once, and then compacts the mesh.
class WorkingMesh {
 public:
  /// Throws as Simplifier does.
  WorkingMesh(Mesh mesh, const SimplifyOptions& options);

  const Mesh& mesh() const { return mesh_; }
  std::uint64_t triangles() const { return mesh_.triangles.size(); }
  std::uint32_t vertices() const { return static_cast<std::uint32_t>(mesh_.positions.size()); }
  std::span<const std::uint8_t> flags() const { return flags_; }  // VertexFlag
  const Adjacency& adjacency() const { return adjacency_; }       // as of the last begin_pass()
  const CreaseLines& creases() const { return creases_; }
  PositionType type() const { return type_; }
  const AppearanceScale& appearance_scale() const { return appearance_scale_; }
  double uv_scale() const { return uv_scale_; }
  bool seam_only() const { return seam_only_; }
  bool avoids_crossings() const { return avoids_crossings_; }
  /// Found where crossings are avoided, without a bound and a seam; kept until the queue begins.
  const SmallPieces& pieces() const { return pieces_; }
  /// Restores the shape of small pieces, once the passes have ended.
  void restore_pieces();
  const Dropped& dropped() const { return dropped_; }
  /// Triangles without a locked vertex.
  std::uint64_t free_triangles() const;
  bool has_free_border() const;
  /// Whether there are more triangles than the goal's, and some edge may go. If there is just one
  /// too many, it goes only where may_lose_one() allows it, at whatever cost; it may stay where
  /// another goal follows.
  bool is_above(const SimplifyGoal& goal) const;
  /// Simplifier::opened.
  std::vector<std::uint32_t> opened() const;
  /// 1 for each vertex that is, or was merged from, a seam vertex, else 0; empty without a seam.
  std::vector<std::uint8_t> seam() const;

  /// Where crossings are avoided: flags as k_thin the vertices that another sheet may be near to.
  /// `last` is the number of triangles left when all is done, `bound` how far the surface may move,
  /// or 0. Returns the distance that counts as near; 0 where crossings are allowed.
  double flag_thin_walls(std::uint64_t last, double bound);

  void begin_pass();
  /// The state of the pass that has begun.
  CollapseState state();
  /// Whether a vertex took part in a collapse of this pass.
  std::span<const std::uint8_t> touched() const { return touched_; }
  void merge(std::uint32_t a, std::uint32_t b, const Collapse& collapse,
             const MergedColumns& columns);
  /// `removed`: how many triangles have gone; `cost`: what the pass might pay.
  void end_pass(std::uint64_t removed, double cost);
  /// After a pass that has removed triangles: the new number of each vertex, or of the vertex it
  /// has merged into, which is smaller than those of all later vertices that stay.
  std::span<const std::uint32_t> numbers() const { return target_; }
  /// Takes over what the queue has made of the mesh.
  void take(const CollapseQueue& queue);

  /// The greatest cost paid so far.
  double max_cost() const { return max_cost_; }
  /// Simplifier::pass_cost.
  double pass_cost() const { return pass_cost_; }

 private:
  void compact();
  void compact_appearances();
  void compact_columns();
  void drop_unused_vertices();
  void move_vertex(std::uint32_t from, std::uint32_t to);
  void keep_vertices(std::uint32_t count);

  Mesh mesh_;
  std::uint32_t locked_;
  PositionType type_;
  bool seam_only_;
  bool avoids_crossings_;
  AppearanceScale appearance_scale_;
  double uv_scale_;
  CreaseLines creases_;
  Dropped dropped_;
  std::vector<std::uint8_t> flags_;
  Adjacency adjacency_;
  SmallPieces pieces_;
  bool adjacency_is_current_ = false;
  std::vector<std::uint32_t> target_;  // the vertex that a vertex becomes in this pass
  std::vector<std::uint8_t> touched_;
  double max_cost_ = 0;
  double pass_cost_ = 0;
};

/// How many triangles are left when all goals are met.
inline std::uint64_t last_of(const SimplifyGoal& goal) {
  return goal.last_triangles > 0 ? goal.last_triangles : goal.triangles;
}

}  // namespace meshfarm
