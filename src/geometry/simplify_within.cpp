// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify_within.hpp>

namespace meshfarm {
namespace {

/// What is round a stray is locked, so that other places come to light; after so many times they
/// are everywhere.
constexpr int k_tries = 4;
/// To find the cost to begin at so much is taken away.
constexpr double k_first_share = 0.9;
/// Costs rise by this factor until the bound is broken: of a smooth surface that leaves two fifths
/// of the triangles. Then by the root of it, and so on.
constexpr double k_first_step = 16;
/// Steps that take less than this share away are not worth their time.
constexpr double k_least_gain = 0.01;
constexpr int k_most_idle = 2;

}  // namespace

BoundedSimplifier::BoundedSimplifier(Mesh mesh, SimplifyOptions options, FindStrays find_strays)
    : options_(std::move(options)), find_strays_(std::move(find_strays)) {
  const Simplifier cleaned(std::move(mesh), options_);
  dropped_degenerate_ = cleaned.dropped_degenerate();
  dropped_duplicate_ = cleaned.dropped_duplicate();
  turned_ = cleaned.turned();
  mesh_ = cleaned.mesh();
}

bool BoundedSimplifier::accept_strays() {
  const std::optional<std::vector<Vec3>> strays = find_strays_(mesh_);
  if (!strays) return false;
  if (strays->empty()) return true;
  first_accepted_ = options_.locked_vertices;
  lock_round(*strays);
  end_accepted_ = options_.locked_vertices;
  return true;
}

bool BoundedSimplifier::is_accepted(const Triangle& triangle) const {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](std::uint32_t v) { return v >= first_accepted_ && v < end_accepted_; });
}

void BoundedSimplifier::drop_accepted(std::vector<Vec3>& strays) const {
  if (first_accepted_ == end_accepted_ || strays.empty()) return;
  const DistanceMeter meter(mesh_, 1);
  std::erase_if(strays, [&](Vec3 stray) {
    return is_accepted(mesh_.triangles[meter.nearest_triangle(stray)]);
  });
}

double BoundedSimplifier::first_cost() const {
  Simplifier simplifier(mesh_, options_);
  simplifier.reduce({.triangles = static_cast<std::uint64_t>(
                         k_first_share * static_cast<double>(simplifier.triangles()))});
  return simplifier.pass_cost();
}

bool BoundedSimplifier::reduce(double max_cost, const Progress& progress) {
  for (int i = 0; i < k_tries; ++i) {
    Simplifier simplifier(mesh_, options_);
    simplifier.reduce({.triangles = 0, .max_cost = max_cost}, progress);
    if (simplifier.triangles() == triangles()) return true;
    std::optional<std::vector<Vec3>> strays = find_strays_(simplifier.mesh());
    if (!strays) return false;
    drop_accepted(*strays);
    if (strays->empty()) {
      mesh_ = simplifier.mesh();
      return true;
    }
    lock_round(*strays);
  }
  return false;
}

/// Locks the corners of the nearest triangle of each stray, and of the triangles round that.
void BoundedSimplifier::lock_round(const std::vector<Vec3>& strays) {
  const DistanceMeter meter(mesh_, 1);
  std::vector<std::uint8_t> near(mesh_.positions.size(), 0);
  for (const Vec3& stray : strays) {
    for (const std::uint32_t v : mesh_.triangles[meter.nearest_triangle(stray)]) near[v] = 1;
  }
  std::vector<std::uint8_t> flags = near;
  for (const auto& [a, b, c] : mesh_.triangles) {
    if ((near[a] | near[b] | near[c]) != 0) flags[a] = flags[b] = flags[c] = 1;
  }
  put_first(flags);
}

/// Locks the flagged vertices with those that are locked: they come first, in the same order.
void BoundedSimplifier::put_first(const std::vector<std::uint8_t>& flags) {
  std::vector<std::uint32_t> number(flags.size());
  Mesh ordered;
  ordered.positions.reserve(flags.size());
  const std::uint32_t locked = options_.locked_vertices;
  for (const bool wanted : {true, false}) {
    for (std::uint32_t v = 0; v < flags.size(); ++v) {
      if ((v < locked || flags[v] != 0) != wanted) continue;
      number[v] = static_cast<std::uint32_t>(ordered.positions.size());
      ordered.positions.push_back(mesh_.positions[v]);
    }
    if (wanted) options_.locked_vertices = static_cast<std::uint32_t>(ordered.positions.size());
  }
  for (Triangle& t : mesh_.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  mesh_.positions = std::move(ordered.positions);
}

double reduce_to_bound(BoundedSimplifier& simplifier, double last_step,
                       const BoundedSimplifier::Progress& tell) {
  double cost = simplifier.first_cost();
  if (cost == 0 && simplifier.reduce(0, tell)) cost = simplifier.first_cost();
  if (!(cost > 0) || !std::isfinite(cost)) return 0;
  cost /= k_first_step;
  for (double step = k_first_step; step >= last_step; step = std::sqrt(step)) {
    int idle = 0;
    do {
      const std::uint64_t before = simplifier.triangles();
      if (!simplifier.reduce(cost * step, tell)) break;
      cost *= step;
      const auto gain = static_cast<double>(before - simplifier.triangles());
      idle = gain < k_least_gain * static_cast<double>(before) ? idle + 1 : 0;
      // What is flat goes for next to nothing, what comes after it is far dearer.
      if (idle == 1) cost = std::max(cost, simplifier.first_cost() / step);
      // Of the later steps there is one: two would be a step that has broken the bound.
    } while (step == k_first_step && idle < k_most_idle);
  }
  return cost;
}

}  // namespace meshfarm
