// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <boost/heap/d_ary_heap.hpp>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/collapse_general.hpp"
#include "geometry/simplify/collapse_guard.hpp"
#include "geometry/simplify/cost_counts.hpp"
#include "geometry/simplify/crossing_guard.hpp"
#include "geometry/simplify/fans.hpp"
#include "geometry/simplify/simplify_lines.hpp"
#include "geometry/simplify/simplify_rank.hpp"
#include "geometry/simplify/small_pieces.hpp"

namespace meshfarm {

/// An edge in the queue. Cheaper edges come first; of equally cheap ones, that of lower vertices.
struct QueuedEdge {
  std::uint64_t order = 0;  // key, then the first end
  std::uint32_t b = 0;
  std::uint32_t stamp = 0;

  QueuedEdge(const RankedEdge& edge, std::uint32_t stamped)
      : order(std::uint64_t{edge.key} << 32 | edge.a), b(edge.b), stamp(stamped) {}
  CostKey key() const { return static_cast<CostKey>(order >> 32); }
  std::uint32_t a() const { return static_cast<std::uint32_t>(order); }
  bool is_later(const QueuedEdge& other) const {
    return order != other.order ? order > other.order : b > other.b;
  }
};

/// The heap keeps the greatest on top, so an edge that comes later compares as less.
struct IsLater {
  bool operator()(const QueuedEdge& x, const QueuedEdge& y) const { return x.is_later(y); }
};
/// The cheapest edge is on top. Most entries are stale before their turn, and with two children per
/// node instead of four each removal would go down twice as many levels.
using QueuedEdges =
    boost::heap::d_ary_heap<QueuedEdge, boost::heap::arity<4>, boost::heap::compare<IsLater>>;

/// A mesh that a queue of edges works on; the queue changes all of it.
struct QueuedMesh {
  std::vector<Vec3>& positions;
  std::vector<std::uint8_t>& flags;  // VertexFlag
  Adjacency& adjacency;
  const CreaseLines& creases;
  PositionType type = PositionType::float64;
  bool seam_only = false;
  bool any_topology = false;             // collapses may change it
  bool stops_when_held = false;          // where most cheap edges are refused
  std::vector<Appearance>& appearances;  // empty if they are not used
  AppearanceScale appearance_scale;
  TriangleColumns& columns;  // what the adjacency was built with
  double uv_scale = 0;
};

/// Collapses edges strictly in order of cost. An edge that was refused, or has become cheaper, is
/// judged again as soon as something around it changes. Takes half as long again as passes, but the
/// order is as good as it can be: for the last part of the way. Where the topology may change,
/// pinched vertices are cut apart.
class CollapseQueue {
 public:
  using Progress = std::function<bool(std::uint64_t)>;

  CollapseQueue(const QueuedMesh& mesh, EdgeRanking& ranking);

  /// Ranks all edges. `triangles` are those that the adjacency was built from.
  void start(std::span<const Triangle> triangles);
  /// After start(): guards that refuse further collapses. `mesh` is the mesh that the queue begins
  /// with.
  void set_guard(CollapseGuard& guard, const Mesh& mesh);
  void set_guard(CrossingGuard& guard, std::span<const Triangle> triangles);
  /// The shapes to restore when four triangles are left of a piece. Needs the crossing guard.
  void set_pieces(SmallPieces& pieces) { pieces_ = &pieces; }

  /// Collapses until the goal is met or no edge is left that ranks within it. Edges that cost
  /// nothing rank slightly above that, by length. May be called again: the order then continues, as
  /// long as most of the ranked triangles are left. Returns false if progress said stop.
  bool reduce(const SimplifyGoal& goal, const Progress& progress);

  /// Restores the shape of pieces that have few triangles left.
  void restore_pieces();
  /// Writes the mesh as it is now, with the vertices in their order, and their flags.
  void copy_to(Mesh& mesh, std::vector<std::uint8_t>& flags, std::uint32_t locked) const;

  std::uint64_t triangles() const { return triangles_; }
  bool any_topology() const { return mesh_.any_topology; }
  double max_cost() const { return max_cost_; }
  /// The cost of the last collapse.
  double last_cost() const { return last_cost_; }
  /// Whether it stopped because too many collapses are refused to keep the topology.
  bool is_held() const { return held_; }
  /// From now on, refusals are no reason to stop.
  void go_on_when_held() { mesh_.stops_when_held = held_ = false; }
  /// The sum and the distribution of the costs of all collapses, without the parts that are
  /// guesses.
  double paid() const { return paid_; }
  const CostCounts& costs() const { return costs_; }
  /// SimplifyGoal::keep_at.
  std::vector<Mesh> take_kept() { return std::move(kept_); }
  std::uint64_t collapses() const { return collapses_; }
  /// Collapses that were refused to keep the topology.
  std::uint64_t kept_topology() const { return kept_topology_; }

 private:
  enum class Stop : std::uint8_t { met, nothing_left, held, too_rough, opened, told };

  void remember();
  PastPlanes planes_at(std::uint32_t vertex) const;
  PastPlanes end_at(std::uint32_t vertex) const;
  void rank(double share);
  bool let_open_for_room(std::uint64_t last);
  Stop run(const SimplifyGoal& goal, const Progress& progress);
  void remember_piece(const QueuedEdge& queued, double cost);
  bool is_queued_otherwise(const QueuedEdge& queued);
  double cost_of_piece(std::uint32_t a, std::uint32_t b) const;
  double cost_of_fewer(const QueuedEdge& queued, double cost, std::uint64_t excess) const;
  bool is_hopeless() const;
  bool is_too_rough() const;
  bool must_wait(const QueuedEdge& queued, double cost) const;
  void wait(const QueuedEdge& queued, double cost);
  void refresh(std::uint32_t vertex);
  bool may_lose_one() const;
  bool is_gone(std::uint32_t vertex) const { return target_[vertex] != vertex; }
  const QueuedEdge* next() const;
  void drop_next();
  void push(const RankedEdge& edge);
  std::uint32_t stamp_of(std::uint32_t a, std::uint32_t b) const { return looks_[a] + looks_[b]; }
  Collapse judge(std::uint32_t a, std::uint32_t b, std::uint64_t most_triangles);
  CollapseGuard::Merge planned(std::uint32_t a, std::uint32_t b, const Collapse& collapse) const;
  bool must_not_cross(const QueuedEdge& queued, const Collapse& collapse);
  bool is_guarded(std::uint32_t a, std::uint32_t b, const Collapse& collapse);
  void merge(std::uint32_t a, std::uint32_t b, const Collapse& collapse);
  void open(const Collapse& collapse);
  void count(const Collapse& collapse);
  bool move(const SmallPieces::Places& places);
  void keep(const SimplifyGoal& goal);
  void update_lines(std::uint32_t merged);
  void tidy(std::uint32_t merged);
  void tidy_star(std::uint32_t vertex);
  void classify(std::uint32_t vertex);
  std::uint32_t add_copy(std::uint32_t vertex);
  void join_stars(std::uint32_t a, std::uint32_t b);
  void list_ring(std::uint32_t vertex);
  void join(const CornerFan& fan, std::size_t place);
  bool may_be_left(std::uint32_t vertex);
  void look_again(std::uint32_t vertex);
  CollapseState state();

  QueuedMesh mesh_;
  EdgeRanking& ranking_;
  CollapseGuard* guard_ = nullptr;
  CrossingGuard* crossings_ = nullptr;
  SmallPieces* pieces_ = nullptr;
  std::vector<std::uint32_t> target_;  // the vertex that a vertex has become
  std::vector<PastPlanes> past_;       // CollapseState::past
  // If an edge to another such vertex would end its piece and was judged: what all such edges of
  // the piece cost, and the one that is queued for them.
  struct PieceEnd {
    double cost = 0;  // 0: not judged
    std::uint32_t a = 0;
    std::uint32_t b = 0;  // 0: none is queued
  };
  std::vector<PieceEnd> piece_ends_;  // by vertex
  // 0 if no edge at the vertex is refused; else 1, plus one per change around the vertex since
  // then. Reset when its edges are ranked again.
  std::vector<std::uint8_t> refused_;
  // How often the edges at each vertex were ranked again. Only increases, so an entry is stale if
  // the sum over its two ends has changed.
  std::vector<std::uint32_t> looks_;
  std::vector<std::uint8_t> stale_;  // its star has changed since its quadric was summed
  double most_cost_ = 0;             // the goal's
  std::uint64_t ranked_at_ = 0;      // triangles left when all edges were ranked
  std::vector<QueuedEdge> first_;    // as ranked at the start, cheapest first
  std::size_t next_first_ = 0;
  QueuedEdges heap_;  // edges queued since then
  CollapseJudge judge_;
  GeneralJudge general_;
  FanSplitter splitter_;
  std::vector<std::uint32_t> tidied_;
  std::vector<std::uint32_t> ring_;
  std::vector<Corner> joined_;
  std::vector<CornerId> joined_ids_;
  std::uint64_t triangles_ = 0;
  std::vector<Mesh> kept_;
  std::size_t next_kept_ = 0;  // of the goal's counts
  // As of the last ranking.
  std::uint64_t blocked_before_ = 0;
  std::uint64_t collapses_before_ = 0;
  std::uint64_t waited_ = 0;  // edges since then that cost more than they ranked by
  double max_cost_ = 0;
  double last_cost_ = 0;
  double paid_ = 0;
  CostCounts costs_;
  std::uint64_t collapses_ = 0;
  std::uint64_t pinches_ = 0;           // since pieces were counted
  std::uint64_t pinches_to_count_ = 0;  // until they are counted again
  std::uint64_t kept_topology_ = 0;
  std::uint64_t blocked_ = 0;  // of these: cheaper than max_cost_
  CostKey limit_ = 0;          // more expensive edges wait for the next ranking
  bool by_general_ = false;    // the last collapse was judged by general_
  bool ends_ = false;          // every edge left would miss the goal
  bool held_ = false;
};

}  // namespace meshfarm
