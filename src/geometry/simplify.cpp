// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "geometry/adjacency.hpp"
#include "geometry/collapse.hpp"
#include "geometry/simplify_clean.hpp"
#include "geometry/simplify_queue.hpp"
#include "geometry/simplify_rank.hpp"
#include "geometry/simplify_rough.hpp"

namespace meshfarm {
namespace {

// Only the cheapest edges are taken before all are ranked anew. With 0.25 or 0.3 the error is the
// same, with 0.5 it is 2 to 4 % more for 10 % less time.
constexpr double k_pass_share = 0.35;

// As long as there are so many times the triangles of the goal, more may be taken at once: the
// error is made later.
constexpr std::uint64_t k_far = 4;
constexpr double k_far_share = 0.5;

// And while there is as much more to go, edges need no ranking at all: rough passes halve the time
// and cost 1 % of the error on the dragon and none on terrain. Down to 8 times the goal they took
// 10 % longer for 1 % less error. A rough pass spares as many of the costliest vertices as the goal
// leaves, but at least these.
constexpr double k_most_rough = 0.97;
// And it keeps this far below the goal's own limit, near which the order matters.
constexpr double k_rough_margin = 8;
// Less than this part of the triangles removed is not worth a rough pass.
constexpr double k_least_rough = 0.1;

// A pass that removes less than this part of the triangles finds that what it ranks is refused.
// What is cheap and refused must not make room for what is dear: the rest is done in order.
constexpr double k_least_ranked = 0.05;
// But where passes have come to the end of what a cost allows, and have left no more than this of
// the triangles, few are refused.
constexpr double k_healthy = 0.66;

// From so many times the triangles of the last goal on edges collapse strictly in order; of a large
// goal from so many times on, as long as passes have no dead ends.
constexpr std::uint64_t k_near = 2;
constexpr double k_near_of_large = 1.25;
constexpr std::uint64_t k_large = 50'000;

// Topology is kept if the sum of the costs, which goes with the square of the error, or the last of
// them is then no more than so many times what it would be without, or if the distance is. A few
// dear ones are no reason.
constexpr double k_fair = 1.44;
constexpr double k_fair_distance = 1.2;
constexpr std::uint64_t k_fair_samples = 5'000;
// Once it is found fair, it is thought of again when so much of the triangles is left.
constexpr double k_decided = 0.8;
// With fewer refusals a collapse it is not even tried.
constexpr double k_costly = 0.25;

// The edges taken in a pass that must not overshoot, as a part of the triangles still to go: each
// that can collapse, about six in ten, removes two.
constexpr double k_most_of_excess = 0.7;

// Vertices whose edges are ranked, sorted and collapsed together: they and their stars fit into a
// core's cache. On 10M triangles this halves the time.
constexpr std::uint32_t k_block = 4096;

using Progress = std::function<bool(std::uint64_t)>;

/// What one pass is to do.
struct Pass {
  CostKey limit = k_any_cost;
  double max_cost = 0;      // the lower of the goal's and what the limit stands for
  std::uint32_t block = 0;  // vertices
};

struct EndGameOptions {
  const CreaseLines* creases = nullptr;
  PositionType type = PositionType::float64;
  bool seam_only = false;
  TopologyMode topology = TopologyMode::keep;
};

/// A mesh of its own and the queue that works on it.
struct EndGame {
  EndGame(const Mesh& mesh, std::vector<std::uint8_t> its_flags, const EndGameOptions& options)
      : positions(mesh.positions),
        flags(std::move(its_flags)),
        queue({positions, flags, adjacency, *options.creases, options.type, options.seam_only,
               options.topology == TopologyMode::simplify,
               options.topology == TopologyMode::automatic ||
                   options.topology == TopologyMode::keep_while_fair},
              ranking) {
    adjacency.build(mesh.triangles, positions.size());
    queue.start(mesh.triangles);
  }

  std::vector<Vec3> positions;
  std::vector<std::uint8_t> flags;
  Adjacency adjacency;
  EdgeRanking ranking;
  CollapseQueue queue;
};

}  // namespace

class Simplifier::Impl {
 public:
  Impl(Mesh mesh, const SimplifyOptions& options)
      : mesh_(std::move(mesh)),
        locked_(options.locked_vertices),
        type_(options.positions),
        seam_only_(!options.seam.empty()),
        topology_(options.lines.topology),
        creases_(options.lines.crease_angle) {
    check_input(mesh_, options);
    Surface surface = clean_surface(mesh_, options, adjacency_);
    dropped_ = surface.dropped;
    flags_ = std::move(surface.flags);
    creases_.find(mesh_, adjacency_, flags_);
    drop_unused_vertices();
    publish_seam();
  }

  void reduce(const SimplifyGoal& goal, const Progress& progress) {
    const std::uint64_t before = mesh_.triangles.size();
    PassEnd end = PassEnd::near;
    if (!end_game_) {
      end = reduce_roughly(goal, progress) ? reduce_by_rank(goal, progress) : PassEnd::told;
    }
    const auto left = static_cast<double>(mesh_.triangles.size());
    const bool done =
        end == PassEnd::told || (end == PassEnd::exhausted && topology_ != TopologyMode::simplify &&
                                 left < k_healthy * static_cast<double>(before));
    if (!done) reduce_in_order(goal, progress);
    if (done && end == PassEnd::exhausted) exhausted_cost_ = goal.max_cost;
    publish_seam();
  }

  const Mesh& mesh() const { return mesh_; }
  std::uint64_t free_triangles() const {
    const auto is_free = [&](const Triangle& t) {
      return t[0] >= locked_ && t[1] >= locked_ && t[2] >= locked_;
    };
    return static_cast<std::uint64_t>(
        std::count_if(mesh_.triangles.begin(), mesh_.triangles.end(), is_free));
  }
  double max_cost() const { return max_cost_; }
  double pass_cost() const { return pass_cost_; }
  std::vector<Mesh> take_kept() {
    return end_game_ ? end_game_->queue.take_kept() : std::vector<Mesh>();
  }
  bool simplifies_topology() const { return end_game_ && end_game_->queue.any_topology(); }
  bool is_held_by_topology() const { return end_game_ && end_game_->queue.is_held(); }
  bool is_hampered_by_topology() const {
    return end_game_ && end_game_->queue.kept_topology() > end_game_->queue.collapses();
  }
  const Dropped& dropped() const { return dropped_; }
  std::span<const std::uint8_t> seam() const { return seam_; }

 private:
  /// Far from the goal. False if progress says stop.
  bool reduce_roughly(const SimplifyGoal& goal, const Progress& progress) {
    while (!seam_only_ && may_go_on(goal) && is_far(goal)) {
      const auto before = static_cast<double>(mesh_.triangles.size());
      const std::uint64_t removed = rough_pass(goal);
      compact(removed);
      if (removed == 0) break;
      if (progress && !progress(mesh_.triangles.size())) return false;
      if (static_cast<double>(removed) < k_least_rough * before) break;
    }
    return true;
  }

  /// The last part of the way, strictly in order.
  void reduce_in_order(const SimplifyGoal& goal, const Progress& progress) {
    if (!may_go_on(goal)) return;
    if (!end_game_) end_game_ = begin_end_game(topology_);
    const double paid_before = end_game_->queue.paid();
    bool goes_on = end_game_->queue.reduce(goal, progress);
    if (goes_on && topology_ == TopologyMode::automatic && !simplifies_topology() &&
        must_decide(goal) && is_costly_to_keep(goal)) {
      auto other = begin_end_game(TopologyMode::simplify);
      goes_on = other->queue.reduce(goal, progress);
      if (is_unfair(end_game_->queue.paid() - paid_before, other->queue, goal)) {
        end_game_ = std::move(other);
      }
    }
    publish(goal, goes_on);
  }

  /// From the mesh as it is.
  std::unique_ptr<EndGame> begin_end_game(TopologyMode topology) {
    return std::make_unique<EndGame>(mesh_, flags_,
                                     EndGameOptions{&creases_, type_, seam_only_, topology});
  }

  /// Not again for a few collapses more: one that is dear would decide for all.
  bool must_decide(const SimplifyGoal& goal) {
    const std::uint64_t left = end_game_->queue.triangles();
    if (left <= goal.triangles + 1 &&
        static_cast<double>(left) > k_decided * static_cast<double>(decided_at_)) {
      return false;
    }
    decided_at_ = left;
    return true;
  }

  /// Whether so much is refused to keep the topology that it is worth a try without.
  bool is_costly_to_keep(const SimplifyGoal& goal) const {
    const CollapseQueue& queue = end_game_->queue;
    if (std::isinf(goal.max_cost) && queue.triangles() > goal.triangles + 1) return true;
    return queue.is_held() || static_cast<double>(queue.kept_topology()) >
                                  k_costly * static_cast<double>(queue.collapses());
  }

  /// Whether to keep the topology costs much more than to simplify it.
  bool is_unfair(double paid, const CollapseQueue& other, const SimplifyGoal& goal) const {
    const CollapseQueue& kept = end_game_->queue;
    if (kept.triangles() > goal.triangles + 1) return other.triangles() < kept.triangles();
    return paid > k_fair * other.paid() && kept.dearest() > k_fair * other.dearest() &&
           distance_to(kept) > k_fair_distance * distance_to(other);
  }

  /// Between the mesh as it is and the queue's, the farther way. A cost does not know how far from
  /// what is left a lost piece lies.
  double distance_to(const CollapseQueue& queue) const {
    Mesh result;
    std::vector<std::uint8_t> flags;
    queue.copy_to(result, flags, 0);
    const auto is_measurable = [](const Mesh& mesh) {
      return !mesh.triangles.empty() &&
             std::all_of(mesh.positions.begin(), mesh.positions.end(), [](Vec3 p) {
               return std::isfinite(squared_length(p) * squared_length(p));
             });
    };
    if (!is_measurable(mesh_) || !is_measurable(result)) return 0;
    const auto from_to = [](const Mesh& from, const Mesh& to) {
      return DistanceMeter(to, 1).measure(sample_surface(from, {k_fair_samples, 1}).points).rms;
    };
    return std::max(from_to(mesh_, result), from_to(result, mesh_));
  }

  void publish(const SimplifyGoal& goal, bool goes_on) {
    const CollapseQueue& queue = end_game_->queue;
    queue.copy_to(mesh_, flags_, locked_);
    max_cost_ = std::max(max_cost_, queue.max_cost());
    pass_cost_ = queue.last_cost();
    if (queue.is_held()) {
      exhausted_cost_ = HUGE_VAL;
    } else if (goes_on && mesh_.triangles.size() > goal.triangles + 1) {
      exhausted_cost_ = goal.max_cost;
    }
  }

  enum class PassEnd : std::uint8_t { near, exhausted, dead_end, told };

  /// As long as the goal is not near, and cheap edges are not refused.
  PassEnd reduce_by_rank(const SimplifyGoal& goal, const Progress& progress) {
    while (may_go_on(goal) && !is_near(goal)) {
      begin_pass();
      const Pass pass = plan_pass(goal, k_pass_share);
      const std::uint64_t before = mesh_.triangles.size();
      const std::uint64_t removed = collapse_edges(goal, pass);
      compact(removed);
      if (progress && !progress(mesh_.triangles.size())) return PassEnd::told;
      // What is cheap is refused: what is dear is not to be taken for it.
      if (refused_for_topology_ > collapses_) return PassEnd::dead_end;
      if (static_cast<double>(removed) < k_least_ranked * static_cast<double>(before)) {
        if (ranks_exactly_ && goal.max_cost > cost_of(pass.limit)) {
          ranks_exactly_ = false;
          continue;
        }
        return goal.max_cost <= cost_of(pass.limit) ? PassEnd::exhausted : PassEnd::dead_end;
      }
    }
    return PassEnd::near;
  }

  bool is_near(const SimplifyGoal& goal) const {
    const std::uint64_t last = last_of(goal);
    const auto of_large = static_cast<std::uint64_t>(k_near_of_large * static_cast<double>(last));
    return mesh_.triangles.size() <= std::min(k_near * last, std::max(of_large, last + k_large));
  }

  bool may_go_on(const SimplifyGoal& goal) const {
    const std::uint64_t triangles = mesh_.triangles.size();
    if (triangles <= goal.triangles || !(goal.max_cost > exhausted_cost_)) return false;
    return triangles - goal.triangles > 1 || has_free_border();
  }

  bool has_free_border() const {
    return std::any_of(flags_.begin(), flags_.end(), [](std::uint8_t flags) {
      return (flags & (k_border | k_fixed)) == k_border;
    });
  }

  static std::uint64_t last_of(const SimplifyGoal& goal) {
    return goal.last_triangles > 0 ? goal.last_triangles : goal.triangles;
  }

  bool is_far(const SimplifyGoal& goal) const {
    const std::uint64_t triangles = mesh_.triangles.size();
    return triangles > k_far * last_of(goal) && triangles > 2 * goal.triangles &&
           mesh_.positions.size() > 2 * std::size_t{k_block};
  }

  void build_adjacency() {
    if (!adjacency_is_current_) adjacency_.build(mesh_.triangles, mesh_.positions.size());
    creases_.update(mesh_, adjacency_, flags_);
  }

  void begin_collapses() {
    const std::size_t vertices = mesh_.positions.size();
    target_.resize(vertices);
    std::iota(target_.begin(), target_.end(), 0U);
    touched_.assign(vertices, 0);
  }

  CollapseState collapse_state() {
    return {mesh_.positions, flags_, target_, &adjacency_, type_, &creases_.test()};
  }

  /// Merges each vertex, in their order, with its nearest neighbour. Returns the triangles removed.
  std::uint64_t rough_pass(const SimplifyGoal& goal) {
    build_adjacency();
    begin_collapses();
    CollapseJudge judge(collapse_state());
    const RoughPass rough({collapse_state(), touched_});
    const std::uint64_t excess = mesh_.triangles.size() - goal.triangles;
    const double left =
        static_cast<double>(last_of(goal)) / static_cast<double>(mesh_.triangles.size());
    const std::optional<double> limit = rough.estimate_limit(
        judge, std::min(k_most_rough, 1 - left), goal.max_cost / k_rough_margin);
    if (!limit) return 0;
    CollapseLimits limits{excess, *limit};
    for (std::uint32_t v = 0; v < touched_.size() && limits.triangles > 1; ++v) {
      if (touched_[v] != 0) continue;
      const std::uint32_t other = rough.partner(v);
      if (other == v) continue;
      const auto [a, b] = std::minmax(v, other);
      const Collapse collapse = judge.judge(a, b, limits);
      if (collapse.triangles == 0) continue;
      merge(a, b, collapse);
      limits.triangles -= collapse.triangles;
    }
    pass_cost_ = *limit;
    return excess - limits.triangles;
  }

  void begin_pass() {
    build_adjacency();
    ranking_.begin_pass({mesh_.positions, mesh_.triangles, flags_, &adjacency_, &creases_.test(),
                         seam_only_, false, false, ranks_exactly_});
  }

  /// Far from the goal passes go block by block and take too few edges to overshoot it; the last
  /// ones take the cheapest edges of the whole mesh first, and stop at the goal.
  Pass plan_pass(const SimplifyGoal& goal, double share) {
    const std::uint64_t triangles = mesh_.triangles.size();
    const std::uint64_t excess = triangles - goal.triangles;
    const auto vertices = static_cast<std::uint32_t>(mesh_.positions.size());
    // One triangle short, only border edges help, and those may rank anywhere.
    if (excess == 1) share = 1;
    if (triangles > k_far * goal.triangles) share = std::max(share, k_far_share);
    const bool far = share < 1 && excess > triangles / 8 && vertices > 2 * k_block;
    Pass pass;
    pass.block = far ? k_block : vertices;
    const double most = far ? k_most_of_excess * static_cast<double>(excess) : HUGE_VAL;
    pass.limit = share >= 1 ? k_any_cost : ranking_.estimate_limit(share, most);
    pass.max_cost = std::min(goal.max_cost, cost_of(pass.limit));
    return pass;
  }

  /// Returns the triangles removed. Sets the cost reached: where it stops at the goal while going
  /// through the whole mesh, that is less than the pass might have paid.
  std::uint64_t collapse_edges(const SimplifyGoal& goal, const Pass& pass) {
    const auto vertices = static_cast<std::uint32_t>(mesh_.positions.size());
    begin_collapses();
    CollapseJudge judge(collapse_state());
    const std::uint64_t excess = mesh_.triangles.size() - goal.triangles;
    CollapseLimits limits{excess, pass.max_cost};
    double reached = pass.max_cost;
    collapses_ = refused_for_topology_ = 0;
    for (std::uint32_t first = 0; first < vertices && limits.triangles > 0; first += pass.block) {
      const std::uint32_t last = std::min(vertices, first + pass.block);
      for (const RankedEdge& e : ranking_.cheapest(first, last, {pass.limit, pass.max_cost})) {
        if ((touched_[e.a] | touched_[e.b]) != 0) continue;
        const Collapse collapse = judge.judge(e.a, e.b, limits);
        refused_for_topology_ += collapse.by_topology ? 1 : 0;
        if (collapse.triangles == 0) continue;
        ++collapses_;
        merge(e.a, e.b, collapse);
        limits.triangles -= collapse.triangles;
        const bool in_order = pass.block == vertices;
        if (limits.triangles <= 1 && in_order) reached = std::min(reached, cost_of(e.key));
        if (limits.triangles == 0) break;
      }
    }
    if (excess > 1) pass_cost_ = std::isfinite(reached) ? reached : max_cost_;
    return excess - limits.triangles;
  }

  void merge(std::uint32_t a, std::uint32_t b, const Collapse& collapse) {
    touched_[a] = touched_[b] = 1;
    target_[b] = a;
    flags_[a] |= flags_[b];
    mesh_.positions[a] = collapse.position;
    max_cost_ = std::max(max_cost_, collapse.cost);
  }

  /// Renumbers the vertices that are left, in their order, and drops the triangles that are gone.
  /// What stays and what goes no processor guesses: all is moved.
  void compact(std::uint64_t removed) {
    adjacency_is_current_ = removed == 0;
    if (removed == 0) return;
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < target_.size(); ++v) {
      // A vertex merges into a smaller one, whose new number is known by now.
      const std::uint32_t target = target_[v];
      const bool stays = target == v;
      mesh_.positions[kept] = mesh_.positions[v];
      flags_[kept] = flags_[v];
      target_[v] = stays ? kept : target_[target];
      kept += stays ? 1 : 0;
    }
    mesh_.positions.resize(kept);
    flags_.resize(kept);
    std::size_t left = 0;
    for (const Triangle& t : mesh_.triangles) {
      const Triangle now = {target_[t[0]], target_[t[1]], target_[t[2]]};
      mesh_.triangles[left] = now;
      const auto [a, b, c] = now;
      const bool is_left = (a != b) & (b != c) & (c != a);
      left += is_left ? 1 : 0;
    }
    mesh_.triangles.resize(left);
  }

  void drop_unused_vertices() {
    target_.resize(mesh_.positions.size());
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < target_.size(); ++v) {
      if (v >= locked_ && adjacency_.count(v) == 0) continue;
      mesh_.positions[kept] = mesh_.positions[v];
      flags_[kept] = flags_[v];
      target_[v] = kept++;
    }
    adjacency_is_current_ = kept == target_.size();
    mesh_.positions.resize(kept);
    flags_.resize(kept);
    for (Triangle& t : mesh_.triangles) t = {target_[t[0]], target_[t[1]], target_[t[2]]};
  }

  void publish_seam() {
    if (!seam_only_) return;
    seam_.resize(flags_.size());
    std::transform(flags_.begin(), flags_.end(), seam_.begin(), [](std::uint8_t flags) {
      return static_cast<std::uint8_t>((flags & k_seam) != 0 ? 1 : 0);
    });
  }

  Mesh mesh_;
  std::uint32_t locked_;
  PositionType type_;
  bool seam_only_;
  TopologyMode topology_;
  CreaseLines creases_;
  Dropped dropped_;
  std::vector<std::uint8_t> flags_;  // VertexFlag
  std::vector<std::uint8_t> seam_;
  double max_cost_ = 0;
  double pass_cost_ = 0;
  double exhausted_cost_ = -1;
  std::uint64_t collapses_ = 0;             // of the last pass
  std::uint64_t refused_for_topology_ = 0;  // in the last pass
  std::uint64_t decided_at_ = UINT64_MAX;   // triangles left when the topology was last thought of

  std::unique_ptr<EndGame> end_game_;
  Adjacency adjacency_;
  bool adjacency_is_current_ = false;
  // Ranks by bounds, so that what is flat goes before what is nearly flat. Where little of that is
  // left most of what ranks low is dearer, and refused.
  bool ranks_exactly_ = true;
  EdgeRanking ranking_;
  std::vector<std::uint32_t> target_;  // the vertex that a vertex becomes in this pass
  std::vector<std::uint8_t> touched_;  // took part in a collapse of this pass
};

Simplifier::Simplifier(Mesh mesh, const SimplifyOptions& options)
    : impl_(std::make_unique<Impl>(std::move(mesh), options)) {}
Simplifier::~Simplifier() = default;
Simplifier::Simplifier(Simplifier&&) noexcept = default;

void Simplifier::reduce(const SimplifyGoal& goal,
                        const std::function<bool(std::uint64_t)>& progress) {
  impl_->reduce(goal, progress);
}
const Mesh& Simplifier::mesh() const {
  return impl_->mesh();
}
std::uint64_t Simplifier::free_triangles() const {
  return impl_->free_triangles();
}
double Simplifier::max_cost() const {
  return impl_->max_cost();
}
double Simplifier::pass_cost() const {
  return impl_->pass_cost();
}
std::vector<Mesh> Simplifier::take_kept() {
  return impl_->take_kept();
}
bool Simplifier::simplifies_topology() const {
  return impl_->simplifies_topology();
}
bool Simplifier::is_hampered_by_topology() const {
  return impl_->is_hampered_by_topology();
}
bool Simplifier::is_held_by_topology() const {
  return impl_->is_held_by_topology();
}
std::uint64_t Simplifier::dropped_degenerate() const {
  return impl_->dropped().degenerate;
}
std::uint64_t Simplifier::dropped_duplicate() const {
  return impl_->dropped().duplicate;
}
std::uint64_t Simplifier::turned() const {
  return impl_->dropped().turned;
}
std::span<const std::uint8_t> Simplifier::seam() const {
  return impl_->seam();
}

}  // namespace meshfarm
