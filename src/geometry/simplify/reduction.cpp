// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/simplify/rough_pass.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// A rough pass that removes less than this share of the triangles is not worth it.
constexpr double k_least_rough = 0.1;

// Where passes have exhausted a cost limit and left at most this share of the triangles, few edges
// are refused. The same holds if the last pass could do nearly all that it tried.
constexpr double k_healthy = 0.66;

// Passes rank no edges at complex vertices. From this share of all vertices on, those may be most
// of the cheap edges, and passes would take the expensive ones between them: blocks of cells then
// have up to 1.9 times the error, and walls of shell models lose the corners of their holes.
constexpr double k_many_complex = 1.0 / 64;

bool has_many_complex(std::span<const std::uint8_t> flags) {
  const auto complex = std::count_if(flags.begin(), flags.end(),
                                     [](std::uint8_t each) { return (each & k_complex) != 0; });
  return static_cast<double>(complex) > k_many_complex * static_cast<double>(flags.size());
}

/// Where crossings are avoided, small handles are not kept at any cost: triangles larger than their
/// handle cross each other and face the wrong way.
TopologyMode chosen_topology(const SimplifyOptions& options) {
  const LineOptions& lines = options.lines;
  const bool gives_way = lines.topology == TopologyMode::automatic && options.bound == nullptr &&
                         lines.crossings == CrossingMode::avoid && options.seam.empty();
  return gives_way ? TopologyMode::simplify : lines.topology;
}

}  // namespace

Reduction::Reduction(Mesh input, const SimplifyOptions& options)
    : mesh_(std::move(input), options),
      topology_(chosen_topology(options)),
      bound_(options.bound),
      may_be_rough_(!mesh_.seam_only() && bound_ == nullptr && !options.was_simplified),
      in_order_(options.in_order || (bound_ == nullptr && has_many_complex(mesh_.flags()))),
      passes_(mesh_, bound_),
      end_(mesh_, topology_, bound_) {}

double Reduction::flag_thin_walls(const SimplifyGoal& goal) {
  if (thickness_ < 0) {
    thickness_ = mesh_.flag_thin_walls(last_of(goal), bound_ != nullptr ? bound_->distance() : 0);
  }
  return thickness_;
}

void Reduction::reduce(const SimplifyGoal& goal, const Progress& progress) {
  if (!(goal.max_cost > exhausted_cost_)) return;
  flag_thin_walls(goal);
  const std::uint64_t before = mesh_.triangles();
  auto came_to = RankedPasses::End::near;
  const bool is_used_up = bound_ != nullptr && bound_->options().is_used_up;
  if (!end_.has_begun() && !in_order_ && !is_used_up) {
    const bool goes_on = reduce_roughly(goal, progress);
    came_to = goes_on ? passes_.reduce(goal, progress) : RankedPasses::End::told;
  }
  const bool is_told = came_to == RankedPasses::End::told && bound_ == nullptr;
  if (came_to == RankedPasses::End::exhausted && is_healthy(before, goal)) {
    exhausted_cost_ = goal.max_cost;
    mesh_.restore_pieces();
  } else if (goal.in_passes && !end_.has_begun()) {
    in_order_ = came_to != RankedPasses::End::told && mesh_.is_above(goal);
    mesh_.restore_pieces();
  } else if (!is_told && mesh_.is_above(goal)) {
    if (const auto cost = end_.reduce(goal, progress)) exhausted_cost_ = *cost;
  }
}

/// Returns false if progress says stop.
bool Reduction::reduce_roughly(const SimplifyGoal& goal, const Progress& progress) {
  while (may_be_rough_ && mesh_.is_above(goal) && RoughPass::is_worth_it(mesh_, goal)) {
    const auto before = static_cast<double>(mesh_.triangles());
    const std::uint64_t removed = RoughPass(mesh_).run(goal);
    may_be_rough_ = removed > 0;
    if (progress && !progress(mesh_.triangles())) return false;
    if (static_cast<double>(removed) < k_least_rough * before) break;
  }
  return true;
}

bool Reduction::is_healthy(std::uint64_t before, const SimplifyGoal& goal) const {
  if (topology_ == TopologyMode::simplify || bound_ != nullptr) return false;
  if (std::isfinite(goal.max_cost) && passes_.refuses_little()) return true;
  return static_cast<double>(mesh_.triangles()) < k_healthy * static_cast<double>(before);
}

}  // namespace meshfarm
