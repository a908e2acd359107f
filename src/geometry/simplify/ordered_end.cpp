// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/ordered_end.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/geometry/distance.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/collapse_guard.hpp"
#include "geometry/simplify/crossing_guard.hpp"
#include "geometry/simplify/simplify_rank.hpp"
#include "geometry/simplify/topology_floor.hpp"

namespace meshfarm {
namespace {

// The topology is kept if the distance is at most this many times as great as without keeping it.
// Costs can't tell: what opens or removes thin pieces counts for more than the distance it makes.
constexpr double k_fair_distance = 1.2;
constexpr std::uint64_t k_fair_samples = 10'000;
// As many as have run the two trials.
constexpr unsigned k_threads = 2;
// Once found fair, this is reconsidered when at most this share of the triangles is left.
constexpr double k_decided = 0.8;
// With smaller goals, simplifying the topology may not get any further: the last piece stays.
constexpr std::uint64_t k_least_goal = 100;
// This quantile of the costs stands for the first collapses.
constexpr double k_first_share = 0.125;
// With fewer refusals per expensive collapse, giving up the topology is not even tried: keeping it
// then mostly cost 1.0 to 1.2 times as much. With 0.75, screws of patches kept theirs at 1 %, at
// 3.5 times the error.
constexpr double k_costly = 0.5;
// With a bound, the topology is given up only if that leaves less than this share of the triangles.
constexpr double k_worth = 0.8;

bool is_measurable(const Mesh& mesh) {
  return !mesh.triangles.empty() &&
         std::all_of(mesh.positions.begin(), mesh.positions.end(),
                     [](Vec3 p) { return std::isfinite(squared_length(p) * squared_length(p)); });
}

/// Measures how far a result is from its mesh. Costs do not know how far a lost piece is from what
/// is left.
class DistanceFrom {
 public:
  /// `mesh` must outlive it.
  explicit DistanceFrom(const Mesh& mesh) {
    if (!is_measurable(mesh)) return;
    points_ = sample_surface(mesh, {k_fair_samples, k_threads}).points;
    to_mesh_.emplace(mesh, k_threads);
  }

  /// The squared RMS distance, the greater of both directions; infinite if one of the two cannot be
  /// measured.
  double squared_to(const CollapseQueue& queue) const {
    Mesh result;
    std::vector<std::uint8_t> flags;
    queue.copy_to(result, flags, 0);
    if (!to_mesh_ || !is_measurable(result)) return HUGE_VAL;
    const std::vector<Vec3> back_from = sample_surface(result, {k_fair_samples, k_threads}).points;
    const double there = DistanceMeter(result, k_threads).measure(points_).rms;
    const double back = to_mesh_->measure(back_from).rms;
    return std::max(there, back) * std::max(there, back);
  }

 private:
  std::vector<Vec3> points_;
  std::optional<DistanceMeter> to_mesh_;
};

}  // namespace

/// A copy of the mesh and the queue that works on it.
struct OrderedEnd::Trial {
  Trial(const WorkingMesh& mesh, TopologyMode topology, const SurfaceBound* bound)
      : positions(mesh.mesh().positions),
        appearances(mesh.mesh().appearances),
        columns(mesh.mesh().columns),
        flags(mesh.flags().begin(), mesh.flags().end()),
        pieces(mesh.pieces()),
        queue({positions, flags, adjacency, mesh.creases(), mesh.type(), mesh.seam_only(),
               topology == TopologyMode::simplify,
               topology == TopologyMode::automatic || topology == TopologyMode::keep_while_fair,
               appearances, mesh.appearance_scale(), columns, mesh.uv_scale()},
              ranking) {
    adjacency.build(mesh.mesh().triangles, positions.size(), columns);
    queue.start(mesh.mesh().triangles);
    if (mesh.avoids_crossings()) {
      crossings.emplace();
      queue.set_guard(*crossings, mesh.mesh().triangles);
      queue.set_pieces(pieces);
      queue.restore_pieces();
    }
    if (bound == nullptr) return;
    guard.emplace(*bound);
    queue.set_guard(*guard, mesh.mesh());
  }

  std::vector<Vec3> positions;
  std::vector<Appearance> appearances;
  TriangleColumns columns;
  std::vector<std::uint8_t> flags;
  SmallPieces pieces;
  Adjacency adjacency;
  EdgeRanking ranking;
  CollapseQueue queue;
  std::optional<CollapseGuard> guard;
  std::optional<CrossingGuard> crossings;
};

/// A trial for the same goal without keeping the topology, run in parallel to the caller's own
/// work.
struct OrderedEnd::Rival {
  /// All arguments must outlive it; none may change.
  Rival(const WorkingMesh& mesh, const SurfaceBound* bound, const SimplifyGoal& goal)
      : done(std::async(std::launch::async, [this, &mesh, bound, &goal] {
          trial = std::make_unique<Trial>(mesh, TopologyMode::simplify, bound);
          trial->queue.reduce(goal, [this](std::uint64_t) { return !stop; });
        })) {}
  ~Rival() { stop = true; }
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;

  /// Null if progress said stop.
  std::unique_ptr<Trial> take(const std::function<bool()>& progress) {
    constexpr std::chrono::milliseconds k_told_every(100);
    while (done.wait_for(k_told_every) != std::future_status::ready) {
      if (!progress()) return nullptr;
    }
    done.get();
    return std::move(trial);
  }

  std::atomic<bool> stop = false;
  std::unique_ptr<Trial> trial;
  std::future<void> done;  // declared last: waits for its end before the others go
};

OrderedEnd::OrderedEnd(WorkingMesh& mesh, TopologyMode topology, const SurfaceBound* bound)
    : mesh_(mesh), topology_(topology), bound_(bound) {}
OrderedEnd::~OrderedEnd() = default;
OrderedEnd::OrderedEnd(OrderedEnd&&) noexcept = default;

std::optional<double> OrderedEnd::reduce(const SimplifyGoal& goal,
                                         const std::function<bool(std::uint64_t)>& progress) {
  if (!simplifies_topology() && cannot_keep(goal)) {
    trial_ = std::make_unique<Trial>(mesh_, TopologyMode::simplify, bound_);
    taken_ = UINT64_MAX;
  }
  if (!has_begun()) trial_ = std::make_unique<Trial>(mesh_, topology_, bound_);
  const bool may_give_up = topology_ == TopologyMode::automatic && !simplifies_topology();
  std::unique_ptr<Rival> rival;
  const auto tell = [&](std::uint64_t left) { return !progress || progress(left); };
  const auto reduce_trial = [&] {
    return trial_->queue.reduce(goal, [&](std::uint64_t left) {
      // Otherwise it would have to be done afterwards, alone.
      if (may_give_up && rival == nullptr && bound_ == nullptr && refuses_much()) {
        rival = std::make_unique<Rival>(mesh_, bound_, goal);
      }
      return tell(left);
    });
  };
  bool goes_on = reduce_trial();
  if (goes_on && may_give_up && is_held_near(goal)) {
    trial_->queue.go_on_when_held();
    goes_on = reduce_trial();
  }
  if (goes_on && may_give_up && must_decide(goal) && is_costly_to_keep(goal)) {
    if (rival == nullptr) rival = std::make_unique<Rival>(mesh_, bound_, goal);
    std::unique_ptr<Trial> other = rival->take([&] { return tell(trial_->queue.triangles()); });
    goes_on = other != nullptr;
    if (goes_on && is_unfair(other->queue, goal)) {
      trial_ = std::move(other);
      taken_ = UINT64_MAX;
    }
  }
  rival.reset();
  trial_->queue.restore_pieces();
  if (trial_->queue.collapses() != taken_ || mesh_.avoids_crossings()) mesh_.take(trial_->queue);
  taken_ = trial_->queue.collapses();
  if (is_held()) return HUGE_VAL;
  if (goes_on && mesh_.triangles() > goal.triangles + 1) return goal.max_cost;
  return std::nullopt;
}

std::vector<Mesh> OrderedEnd::take_kept() {
  return has_begun() ? trial_->queue.take_kept() : std::vector<Mesh>();
}

bool OrderedEnd::simplifies_topology() const {
  return has_begun() && trial_->queue.any_topology();
}

bool OrderedEnd::is_held() const {
  return has_begun() && trial_->queue.is_held();
}

std::uint64_t OrderedEnd::refused_by_topology() const {
  return has_begun() ? trial_->queue.kept_topology() : 0;
}

bool OrderedEnd::is_hampered() const {
  return has_begun() && refused_by_topology() > trial_->queue.collapses();
}

/// Whether the goal has too few triangles for the topology. If so, keeping it need not be tried.
bool OrderedEnd::cannot_keep(const SimplifyGoal& goal) const {
  if (topology_ != TopologyMode::automatic || bound_ != nullptr) return false;
  if (std::isfinite(goal.max_cost) || goal.triangles < k_least_goal) return false;
  Adjacency adjacency;
  adjacency.build(mesh_.mesh().triangles, mesh_.vertices());
  return least_triangles(mesh_.flags(), adjacency) > goal.triangles + 1;
}

/// Being held may be a false alarm: on flat plates, refused edges cost nothing and are judged again
/// and again. This near to the goal, it is no reason by itself to give up the topology.
bool OrderedEnd::is_held_near(const SimplifyGoal& goal) const {
  constexpr std::uint64_t k_near = 4;
  return bound_ == nullptr && is_held() && trial_->queue.triangles() <= k_near * goal.triangles;
}

/// Not again after a few more collapses: a single expensive one would decide for all.
bool OrderedEnd::must_decide(const SimplifyGoal& goal) {
  const std::uint64_t left = trial_->queue.triangles();
  if (left <= goal.triangles + 1 &&
      static_cast<double>(left) > k_decided * static_cast<double>(decided_at_)) {
    return false;
  }
  decided_at_ = left;
  return true;
}

/// Whether enough is refused to keep the topology to make a trial without worthwhile.
bool OrderedEnd::is_costly_to_keep(const SimplifyGoal& goal) const {
  const CollapseQueue& queue = trial_->queue;
  if (bound_ == nullptr && std::isinf(goal.max_cost) && queue.triangles() > goal.triangles + 1) {
    return true;
  }
  return queue.is_held() || refuses_much();
}

bool OrderedEnd::refuses_much() const {
  return static_cast<double>(refused_by_topology()) >
         k_costly * static_cast<double>(trial_->queue.costs().dear());
}

/// Estimates what the mesh had cost before this, as a share of what `other` paid: neither result is
/// nearer to the input than that. The squared error goes as one over the square of the triangles;
/// where the first collapses were cheaper than that, they are used.
double OrderedEnd::share_paid_before(const CollapseQueue& other) const {
  const auto triangles = static_cast<double>(mesh_.triangles());
  const double times =
      triangles / static_cast<double>(std::max<std::uint64_t>(1, other.triangles()));
  const double first = other.costs().quantile(k_first_share);
  // Four times what was paid before, if a collapse costs as one over the cube of the triangles.
  const double of_first = first * triangles;
  return std::min(1 / std::max(times * times - 1, 1e-6), of_first / other.paid());
}

/// Whether keeping the topology leads much farther from the mesh than simplifying it.
bool OrderedEnd::is_unfair(const CollapseQueue& other, const SimplifyGoal& goal) const {
  const CollapseQueue& kept = trial_->queue;
  if (bound_ != nullptr) {
    return static_cast<double>(other.triangles()) < k_worth * static_cast<double>(kept.triangles());
  }
  if (kept.triangles() > goal.triangles + 1) return other.triangles() < kept.triangles();
  const DistanceFrom distance(mesh_.mesh());
  const double squared = distance.squared_to(other);
  const double squared_kept = distance.squared_to(kept);
  const double before = squared * share_paid_before(other);
  return before + squared_kept > k_fair_distance * k_fair_distance * (before + squared);
}

}  // namespace meshfarm
