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

/// What happens to handles, holes, strips and pieces.
enum class TopologyMode : std::uint8_t {
  /// Kept if the goal can be met that way at a fair error, else simplified.
  automatic,
  keep,
  /// Handles and strips are pinched off, holes closed and pieces removed as soon as that is the
  /// cheapest operation. Whatever is pinched is cut apart, so that the result stays as manifold as
  /// the input.
  simplify,
  /// Kept. Where the topology forbids most of the cheap collapses, the work stops short of the
  /// goal.
  keep_while_fair,
};

/// What happens to collapses whose new triangles would cross others.
enum class CrossingMode : std::uint8_t {
  allow,
  /// Collapses that add to the pairs of triangles that cross (crossings.hpp) are refused; crossings
  /// of the input lock nothing. Near the goal such collapses cost 64 times as much instead, so that
  /// the goal is met, and are refused only under a bound on the error. Near the goal all collapses
  /// are checked, farther away those in thin walls, farthest away none. Walls are thin where
  /// triangles face each other within 0.15 of the final edge length, or about as near. Without a
  /// bound and a seam, TopologyMode::automatic then means `simplify`: a handle smaller than the
  /// triangles can neither be kept apart nor face the right way.
  ///
  /// Where most triangles of thin walls have a twin on the other side (a surface and its offset,
  /// without appearances and columns), one sheet stands for both, and they do not cross anywhere,
  /// however near they are. Such sheets lose triangles in fours: up to three more than the goal may
  /// be left until the same goal is asked for again.
  avoid,
};

/// How much appearances count relative to the shape.
struct AppearanceScale {
  /// The distance by which the surface must move to be as bad as an appearance error of the whole
  /// range. If 0, appearances are dropped, and only the shape counts.
  double length = 0;
  /// The steepest gradient of an appearance, as such a length per length; steeper ones count as
  /// this. Otherwise a sharp line between two colours would cost the more, the finer the mesh, and
  /// noise would drown the shape.
  double steepest = 0.2;
};

/// Requirements on the lines and the topology of a surface, beyond borders keeping their shape like
/// the rest.
struct LineOptions {
  /// Vertices on open borders are neither moved nor removed.
  bool preserve_border = false;
  /// In degrees below 180; 0: no creases. An edge whose two triangles' normals differ by more than
  /// this is a crease. Vertices on creases merge only along them, and stay where creases meet or
  /// end.
  double crease_angle = 0;
  TopologyMode topology = TopologyMode::automatic;
  AppearanceScale appearance_scale;
  /// The columns that triangles keep; others are dropped. Vertices where triangles of two labels
  /// meet, or two charts of texture coordinates, merge only along these lines, so that regions keep
  /// their shape; those between charts keep their places on both pictures.
  ColumnSet columns{true, true};
  /// The distance by which the surface must move to be as bad as showing a place of the picture
  /// that is 1 away from the right one. If 0, only the shape counts inside a chart.
  double uv_scale = 0;
  CrossingMode crossings = CrossingMode::allow;
};

class SurfaceBound;

struct SimplifyOptions {
  /// The first n vertices are neither moved nor removed: they keep their indices 0..n-1.
  std::uint32_t locked_vertices = 0;
  /// Positions of new vertices are rounded to this before they are checked.
  PositionType positions = PositionType::float64;
  /// If not empty: one flag per vertex; only edges that touch a flagged vertex may collapse (the
  /// seam-only pass of Xiong et al. 2008, 3.3). A vertex merged from a flagged one is flagged.
  std::vector<std::uint8_t> seam;
  /// Vertices of sheets that were closed pieces (Simplifier::opened): as each of these stands for
  /// two sides, its collapses cost more.
  std::vector<std::uint32_t> opened;
  LineOptions lines;
  /// The mesh, or most of it, comes from a simplifier. Edges are then taken by their cost even far
  /// from the goal, because merging nearest neighbours is no longer worthwhile.
  bool was_simplified = false;
  /// Edges collapse strictly in order of cost from the start, as if the passes were over.
  bool in_order = false;
  /// If not null: collapses that would take the surface farther from this one than it allows are
  /// refused. It must outlive the simplifier.
  const SurfaceBound* bound = nullptr;
};

/// How far to go: the first limit that is met counts.
struct SimplifyGoal {
  /// Stop at this many triangles. If another goal follows, one more may be left, as a single
  /// triangle can go only at an open border. For the last goal, up to 0.1 % fewer may be left (2 %
  /// for goals below 1,000) where the last collapses would otherwise cost far more, or nothing else
  /// can go.
  std::uint64_t triangles = 0;
  /// Collapse no edge that costs more. A cost is an area times a squared distance: the sum, over
  /// the triangles round the edge just before the collapse, of area x squared distance of the new
  /// vertex to their planes. Each crease edge adds two planes perpendicular to its triangles, each
  /// as heavy as three squares on the edge; each edge of an open border adds one, at a tenth of
  /// that weight except at corners. Area that is lost or gained, tips, slivers, ends of ribbons and
  /// changes of the topology cost more than the planes tell: docs/kernel.md has the terms. The cost
  /// depends only on the mesh near the edge, and on the distance to the rest for what is removed as
  /// a whole, so the costs of different parts can be compared.
  double max_cost = std::numeric_limits<double>::infinity();
  /// About how many triangles will be left when all following goals are met; 0: none follows. The
  /// farther away that is, the less care a collapse needs.
  std::uint64_t last_triangles = 0;
  /// Stop where edges would begin to collapse strictly in order. If that is before the goal, the
  /// next goal begins with it.
  bool in_passes = false;
  /// Falling triangle counts. A copy of the mesh is kept when it first has at most that many
  /// triangles, if edges collapse strictly in order by then. The copy is dropped when far fewer
  /// triangles are left. No result depends on this.
  std::vector<std::uint64_t> keep_at;
};

/// Iterative edge collapse by quadric error (Garland & Heckbert 1997). The quadrics are memoryless
/// (Lindstrom & Turk 1999): computed from the current mesh. Far from the goal, edges collapse in
/// passes without a heap; near it, strictly in order of their cost.
///
/// Needs about 50 bytes per triangle besides the mesh, or 70 if the goal is near the input's count;
/// 40 more near the goal if more than two sheets meet anywhere; if crossings are avoided, 80 more
/// in thin walls and near the goal, and as much in sheets with twins.
///
/// The input may be dirty: degenerate and duplicate triangles are dropped and counted; vertices on
/// non-manifold edges merge along these edges. No triangle flips, except on ribbons that are much
/// narrower than their triangles are long; none becomes degenerate. Deterministic: the same mesh,
/// options and goals give the same bytes.
class Simplifier {
 public:
  /// Throws UsageError if the options do not fit the mesh or the mesh is too big (over 2^32 / 3
  /// vertices or triangles), DataError if a triangle names a vertex that does not exist.
  Simplifier(Mesh mesh, const SimplifyOptions& options);
  ~Simplifier();
  Simplifier(Simplifier&&) noexcept;

  /// Collapses until the goal is met or no allowed collapse is left; with a finite max_cost, until
  /// a pass over all that it allows removes less than 4 %. May be called again with a farther goal.
  /// Returns at once if the goal is already met or its cost exhausted. `progress` (may be empty) is
  /// called with the number of triangles left after each pass, and stops the work by returning
  /// false.
  void reduce(const SimplifyGoal& goal,
              const std::function<bool(std::uint64_t triangles_left)>& progress = {});

  /// The current mesh: no unused vertices (except the locked ones), original order kept.
  const Mesh& mesh() const;
  std::uint64_t triangles() const { return mesh().triangles.size(); }
  /// Triangles without locked vertices: what a part can still be asked to give.
  std::uint64_t free_triangles() const;
  /// Whether the mesh has an open border along which edges can collapse, removing one triangle
  /// each.
  bool has_free_border() const;
  /// The greatest cost paid so far.
  double max_cost() const;
  /// The cost level that the mesh has reached: what the last pass was allowed to pay, passes that
  /// mostly refused left out; or, where edges then collapsed strictly in order, the cost of the
  /// last collapse, if that is greater.
  double pass_cost() const;
  /// The last few copies that SimplifyGoal::keep_at asked for, in that order.
  std::vector<Mesh> take_kept();
  /// Whether the topology was given up.
  bool simplifies_topology() const;
  /// Whether sheets with the same triangles are simplified as one (CrossingMode::avoid).
  bool pairs_sheets() const;
  /// Whether it stopped as described at TopologyMode::keep_while_fair.
  bool is_held_by_topology() const;
  /// How often an edge was refused to keep the topology, counted while edges collapse in order. The
  /// same edge may count many times.
  std::uint64_t refused_by_topology() const;
  /// Whether there were more such refusals than collapses.
  bool is_hampered_by_topology() const;
  /// Whether the last reduce() refused more than one edge per 100 collapses to keep the topology,
  /// or edges already collapse in order, which is_hampered_by_topology() covers.
  bool is_slowed_by_topology() const;
  std::uint64_t dropped_degenerate() const;
  std::uint64_t dropped_duplicate() const;
  /// Input triangles that faced against most of their piece's area, and were turned.
  std::uint64_t turned() const;
  /// The vertices of mesh() in sheets that were closed pieces, in ascending order.
  std::vector<std::uint32_t> opened() const;
  /// Flags of the vertices of mesh() that are seam vertices or were merged from them.
  std::span<const std::uint8_t> seam() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
