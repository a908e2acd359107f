// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/ordered_end.hpp"
#include "geometry/simplify/ranked_passes.hpp"
#include "geometry/simplify/rough_pass.hpp"
#include "geometry/simplify/working_mesh.hpp"

namespace meshfarm {
namespace {

// Less than this part of the triangles removed is not worth a rough pass.
constexpr double k_least_rough = 0.1;

// Where passes have come to the end of what a cost allows, and have left no more than this of the
// triangles, few are refused. Nor are many if the last pass could do nearly all that it tried.
constexpr double k_healthy = 0.66;

using Progress = std::function<bool(std::uint64_t)>;

/// Where crossings are avoided small handles are not kept at any cost: the triangles of a handle
/// smaller than they are cross each other, and face the wrong way.
TopologyMode chosen_topology(const SimplifyOptions& options) {
  const LineOptions& lines = options.lines;
  const bool gives_way = lines.topology == TopologyMode::automatic && options.bound == nullptr &&
                         lines.crossings == CrossingMode::avoid && options.seam.empty();
  return gives_way ? TopologyMode::simplify : lines.topology;
}

}  // namespace

/// Rough passes far from the goal, then ranked ones, and the last part of the way in order.
struct Simplifier::Impl {
  Impl(Mesh input, const SimplifyOptions& options)
      : mesh(std::move(input), options),
        topology(chosen_topology(options)),
        bound(options.bound),
        passes(mesh, bound),
        end(mesh, topology, bound),
        seam(mesh.seam()) {}

  void reduce(const SimplifyGoal& goal, const Progress& progress) {
    if (!(goal.max_cost > exhausted_cost)) return;
    if (!std::exchange(is_flagged, true)) {
      mesh.flag_thin_walls(last_of(goal), bound != nullptr ? bound->distance() : 0);
    }
    const std::uint64_t before = mesh.triangles();
    auto came_to = RankedPasses::End::near;
    const bool is_used_up = bound != nullptr && bound->options().is_used_up;
    if (!end.has_begun() && !is_used_up) {
      const bool goes_on = reduce_roughly(goal, progress);
      came_to = goes_on ? passes.reduce(goal, progress) : RankedPasses::End::told;
    }
    const bool is_told = came_to == RankedPasses::End::told && bound == nullptr;
    if (came_to == RankedPasses::End::exhausted && is_healthy(before, goal)) {
      exhausted_cost = goal.max_cost;
    } else if (!is_told && mesh.is_above(goal.triangles)) {
      if (const auto cost = end.reduce(goal, progress)) exhausted_cost = *cost;
    }
    seam = mesh.seam();
  }

  /// False if progress says stop.
  bool reduce_roughly(const SimplifyGoal& goal, const Progress& progress) {
    while (!mesh.seam_only() && bound == nullptr && mesh.is_above(goal.triangles) &&
           RoughPass::is_worth_it(mesh, goal)) {
      const auto before = static_cast<double>(mesh.triangles());
      const std::uint64_t removed = RoughPass(mesh).run(goal);
      if (removed == 0) break;
      if (progress && !progress(mesh.triangles())) return false;
      if (static_cast<double>(removed) < k_least_rough * before) break;
    }
    return true;
  }

  bool is_healthy(std::uint64_t before, const SimplifyGoal& goal) const {
    if (topology == TopologyMode::simplify || bound != nullptr) return false;
    if (std::isfinite(goal.max_cost) && passes.refuses_little()) return true;
    return static_cast<double>(mesh.triangles()) < k_healthy * static_cast<double>(before);
  }

  WorkingMesh mesh;
  TopologyMode topology;
  const SurfaceBound* bound;
  RankedPasses passes;
  OrderedEnd end;
  std::vector<std::uint8_t> seam;
  bool is_flagged = false;     // thin walls
  double exhausted_cost = -1;  // nothing is left that costs no more
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
  return impl_->mesh.mesh();
}
std::uint64_t Simplifier::free_triangles() const {
  return impl_->mesh.free_triangles();
}
double Simplifier::max_cost() const {
  return impl_->mesh.max_cost();
}
double Simplifier::pass_cost() const {
  return impl_->mesh.pass_cost();
}
std::vector<Mesh> Simplifier::take_kept() {
  return impl_->end.take_kept();
}
bool Simplifier::simplifies_topology() const {
  return impl_->end.simplifies_topology();
}
bool Simplifier::is_hampered_by_topology() const {
  return impl_->end.is_hampered();
}
bool Simplifier::is_held_by_topology() const {
  return impl_->end.is_held();
}
bool Simplifier::is_slowed_by_topology() const {
  return impl_->end.has_begun() || impl_->passes.is_slowed_by_topology();
}
std::uint64_t Simplifier::dropped_degenerate() const {
  return impl_->mesh.dropped().degenerate;
}
std::uint64_t Simplifier::dropped_duplicate() const {
  return impl_->mesh.dropped().duplicate;
}
std::uint64_t Simplifier::turned() const {
  return impl_->mesh.dropped().turned;
}
std::span<const std::uint8_t> Simplifier::seam() const {
  return impl_->seam;
}

}  // namespace meshfarm
