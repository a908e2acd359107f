// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// What becomes of handles, holes, strips and pieces.
enum class TopologyMode : std::uint8_t {
  /// Kept if the goal can be met so at a fair error, else simplified.
  automatic,
  keep,
  /// Handles and strips are pinched off, holes closed and pieces removed as soon as that is the
  /// cheapest thing to do. What is pinched is cut apart, so that the result is no less manifold.
  simplify,
  /// Kept. Where most of what is cheap is refused for it, the work stops short of the goal.
  keep_while_fair,
};

/// What becomes of collapses whose new triangles would cross others.
enum class CrossingMode : std::uint8_t {
  allow,
  /// They are refused, but for those near the goal, which cost 64 times as much and are refused
  /// only under a bound on the error: so the goal is met. Such is a collapse that adds to the pairs
  /// of triangles that cross (crossings.hpp); those of the input lock nothing. Near the goal all
  /// collapses are looked at, farther away those in thin walls, farthest none. Walls are thin where
  /// triangles face each other within 0.15 of the length that edges have in the end, or about as
  /// near. Without a bound and a seam, TopologyMode::automatic is `simplify` then: a handle smaller
  /// than the triangles can neither be kept apart nor face the right way.
  ///
  /// Where most triangles of thin walls have a twin on the other side (a surface and its offset,
  /// without appearances and columns), one sheet stands for both, and they cross nowhere, however
  /// near they are. They lose triangles by four: up to three more than the goal may be left until
  /// the same is asked for once more.
  avoid,
};

/// How much appearances count beside the shape.
struct AppearanceScale {
  /// The length of a move of the surface that is as bad as an error of an appearance by its whole
  /// range. Where it is 0 appearances are dropped, and only the shape counts.
  double length = 0;
  /// Steeper gradients, of an appearance as such a length over a length, count as if they were no
  /// steeper: else a sharp line between two colours would be the worse the finer the mesh, and
  /// noise would drown the shape.
  double steepest = 0.2;
};

/// What is asked of the lines and the topology of a surface, beyond that borders keep their shape
/// like the rest.
struct LineOptions {
  /// Vertices on open borders neither move nor go.
  bool preserve_border = false;
  /// In degrees below 180, 0 for none: edges whose two triangles' normals differ by more than this
  /// are creases. Vertices on creases merge along them only, and where creases meet or end they
  /// stay where they are.
  double crease_angle = 0;
  TopologyMode topology = TopologyMode::automatic;
  AppearanceScale appearance_scale;
  /// The columns that triangles keep. Vertices where triangles of two labels meet, or two charts of
  /// texture coordinates, merge along these lines only, so that regions keep their shape; those
  /// between charts stay on their places of both pictures. Other columns are dropped.
  ColumnSet columns{true, true};
  /// The length of a move of the surface that is as bad as to show a place on the picture that is 1
  /// away from the right one. 0: inside a chart only the shape counts.
  double uv_scale = 0;
  CrossingMode crossings = CrossingMode::allow;
};

class SurfaceBound;

struct SimplifyOptions {
  /// The first n vertices neither move nor go: they keep their indices 0..n-1.
  std::uint32_t locked_vertices = 0;
  /// Positions of new vertices are rounded to this before they are checked.
  PositionType positions = PositionType::float64;
  /// Where not empty: one flag a vertex; only edges that touch a flagged vertex may collapse
  /// (the seam-only pass of Xiong et al. 2008, 3.3). A vertex merged from a flagged one is flagged.
  std::vector<std::uint8_t> seam;
  LineOptions lines;
  /// The mesh, or most of it, comes from a simplifier: far from the goal, too, edges are taken by
  /// their cost, as nearest neighbours are not worth merging any more.
  bool was_simplified = false;
  /// Edges collapse strictly in order from the start, as if passes had come to their end.
  bool in_order = false;
  /// Where not null: collapses that would take the surface farther from this one than it allows are
  /// refused. It must outlive the simplifier.
  const SurfaceBound* bound = nullptr;
};

/// How far to go: whichever limit is met first.
struct SimplifyGoal {
  /// Stop at this many triangles. Where another goal follows one more may be left, as a single one
  /// goes at an open border only. Of the last goal up to 0.1 % fewer may be left (of fewer than
  /// 1,000 up to 2 %) where the last collapses would else cost far more, or nothing else can go.
  std::uint64_t triangles = 0;
  /// Collapse no edge that costs more. A cost is an area times a squared distance: the sum over the
  /// triangles round the edge, as they are just before, of area x squared distance of the new
  /// vertex to their planes; open borders add a plane along each border edge, as heavy as three
  /// squares on it, creases two. No less than 0.8 of the area that the surface loses x the edge's
  /// squared length, since planes do not see a spike draw back, or 0.2 of what it gains x the
  /// square of five times the width of that, along the edge, or of the edge's length, if that is
  /// less, or three times the square of how far a tip goes beyond all round it, if that is more.
  /// Sides of ribbons weigh less, and there gains are free. It depends on nothing else but
  /// for changes of the topology: costs of parts compare.
  double max_cost = std::numeric_limits<double>::infinity();
  /// About how many triangles will be left when all goals that follow are met; 0: none follows.
  /// The farther the end, the less care a collapse needs.
  std::uint64_t last_triangles = 0;
  /// Stop where edges would begin to collapse strictly in order. If that is before the goal, the
  /// next one begins with it.
  bool in_passes = false;
  /// Falling counts: the mesh is kept as it was when no more than so many triangles were left, if
  /// edges collapsed strictly in order by then, and dropped again when those left are far fewer. No
  /// result depends on it.
  std::vector<std::uint64_t> keep_at;
};

/// Iterative edge collapse by quadric error (Garland & Heckbert 1997); quadrics are memoryless
/// (Lindstrom & Turk 1999): made from the mesh as it is. Far from the goal edges collapse in passes
/// without a heap, near it strictly in order of their cost.
///
/// Needs about 50 bytes a triangle beside the mesh, 70 if the goal is near the input's count; where
/// more than two sheets meet anywhere 40 more near the goal; where crossings are avoided 80 more in
/// thin walls and near the goal, and as much in sheets with twins.
///
/// The input may be dirty: degenerate and duplicate triangles are dropped and counted; vertices on
/// non-manifold edges merge along these. No triangle flips, but on ribbons that are much narrower
/// than their triangles are long; none becomes degenerate.
/// Deterministic: same mesh, options and goals, same bytes.
class Simplifier {
 public:
  /// Throws UsageError if the options do not fit the mesh or it is too big (over 2^32 / 3 vertices
  /// or triangles), DataError if a triangle names a vertex that does not exist.
  Simplifier(Mesh mesh, const SimplifyOptions& options);
  ~Simplifier();
  Simplifier(Simplifier&&) noexcept;

  /// Collapses until the goal is met or nothing that is allowed is left; with a finite max_cost,
  /// until a pass over all that it allows removes less than 4 %. May be called again with a farther
  /// goal; with one that is met, or a cost that was exhausted, it returns at once. `progress` (may
  /// be empty) is told the triangles left after each pass, and stops the work by returning false.
  void reduce(const SimplifyGoal& goal,
              const std::function<bool(std::uint64_t triangles_left)>& progress = {});

  /// The mesh as it is now: no unused vertices (but the locked ones), original order kept.
  const Mesh& mesh() const;
  std::uint64_t triangles() const { return mesh().triangles.size(); }
  /// Triangles none of whose vertices is locked: what a part can still be asked to give.
  std::uint64_t free_triangles() const;
  /// Whether it has an open border along which edges can be collapsed: one triangle at a time.
  bool has_free_border() const;
  /// The greatest cost paid so far.
  double max_cost() const;
  /// The level that the mesh has reached: what the last pass might pay, or, where edges collapse
  /// strictly in order, the cost of the last.
  double pass_cost() const;
  /// What SimplifyGoal::keep_at asked for, in that order: the last few.
  std::vector<Mesh> take_kept();
  /// Whether the topology was given up.
  bool simplifies_topology() const;
  /// Whether sheets with the same triangles are simplified as one (CrossingMode::avoid).
  bool pairs_sheets() const;
  /// Whether it stopped as TopologyMode::keep_while_fair says.
  bool is_held_by_topology() const;
  /// How often an edge was refused to keep the topology, of what was done in order. One may be
  /// again and again.
  std::uint64_t refused_by_topology() const;
  /// Whether that is more than what collapsed.
  bool is_hampered_by_topology() const;
  /// Whether of what the last reduce() tried one edge in a hundred or more was refused to keep the
  /// topology, or edges collapse in order by now, of which is_hampered_by_topology() tells.
  bool is_slowed_by_topology() const;
  std::uint64_t dropped_degenerate() const;
  std::uint64_t dropped_duplicate() const;
  /// Triangles of the input that faced another way than most of their piece's area, and were
  /// turned.
  std::uint64_t turned() const;
  /// Flags of the vertices of mesh() that are, or were merged from, seam vertices.
  std::span<const std::uint8_t> seam() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
