// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <utility>

#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/reduction.hpp"
#include "geometry/simplify/sheet_pairs.hpp"

namespace meshfarm {
namespace {

// Vertices are held where sheets end: at most one per this many triangles that are left in the end.
constexpr std::uint64_t k_triangles_a_held = 10;
// Two sheets lose four triangles at a time.
constexpr std::uint64_t k_least_excess = 4;

/// Whether a sheet may stand for its twin, if there are any.
bool may_pair(const Mesh& input, const SimplifyOptions& options) {
  const bool has_more = options.lines.columns.and_in(input.columns.set()).any() ||
                        (options.lines.appearance_scale.length > 0 && !input.appearances.empty());
  return options.lines.crossings == CrossingMode::avoid && options.bound == nullptr &&
         options.seam.empty() && !has_more;
}

}  // namespace

/// Where most of the surface is in pairs of sheets with the same triangles, one of each pair is
/// reduced for both; else the whole surface is reduced.
struct Simplifier::Impl {
  Impl(Mesh input, const SimplifyOptions& given)
      : locked(given.locked_vertices),
        positions(given.positions),
        lines(given.lines),
        may_be_paired(may_pair(input, given)),
        reduction(std::make_unique<Reduction>(std::move(input), given)),
        seam(reduction->mesh().seam()),
        dropped(reduction->mesh().dropped()) {}

  void reduce(const SimplifyGoal& goal, const Reduction::Progress& progress) {
    if (std::exchange(may_be_paired, false)) pair_sheets(goal);
    both.reset();
    if (pairs) {
      if (reduce_pairs(goal, progress)) return;
      take_apart();
    }
    reduction->reduce(goal, progress);
    seam = reduction->mesh().seam();
  }

  void pair_sheets(const SimplifyGoal& goal) {
    const double thickness = reduction->flag_thin_walls(goal);
    const WorkingMesh& mesh = reduction->mesh();
    if (!(thickness > 0)) return;
    pairs = SheetPairs::find(mesh.mesh(), mesh.flags(),
                             {locked, positions, thickness, last_of(goal) / k_triangles_a_held});
    if (pairs) restart(pairs->take_single(), pairs->locked());
  }

  void take_apart() {
    Mesh mesh = pairs->both(reduction->mesh().mesh());
    pairs.reset();
    restart(std::move(mesh), locked);
  }

  void restart(Mesh mesh, std::uint32_t locked_now) {
    paid = max_cost();
    SimplifyOptions options{.locked_vertices = locked_now, .positions = positions, .lines = lines};
    options.lines.columns.labels = true;  // of pairs
    reduction = std::make_unique<Reduction>(std::move(mesh), options);
  }

  /// Returns false if it was asked again for what it could not do before.
  bool reduce_pairs(const SimplifyGoal& goal, const Reduction::Progress& progress) {
    bool goes_on = true;
    bool is_new = goal.triangles < asked.triangles || goal.max_cost > asked.max_cost;
    asked = goal;
    while (goes_on) {
      const Mesh& single = reduction->mesh().mesh();
      const std::uint64_t before = single.triangles.size();
      const std::uint64_t all = pairs->triangles_of(single);
      const std::uint64_t excess = all - std::min(all, goal.triangles);
      if (excess < k_least_excess) {
        return is_new || excess <= 1 || last_of(goal) < goal.triangles;
      }
      const auto share_of = [&](std::uint64_t count) {
        return static_cast<std::uint64_t>(static_cast<double>(count) * static_cast<double>(before) /
                                          static_cast<double>(all));
      };
      SimplifyGoal of_single{.triangles = before - excess / 2,
                             .max_cost = goal.max_cost,
                             .last_triangles = share_of(goal.last_triangles),
                             .in_passes = goal.in_passes};
      for (const std::uint64_t count : goal.keep_at) of_single.keep_at.push_back(share_of(count));
      reduction->reduce(of_single, [&](std::uint64_t left) {
        goes_on = !progress || progress(all - std::min(all, 2 * (before - left)));
        return goes_on;
      });
      if (reduction->mesh().triangles() == before) return is_new;
      is_new = true;
    }
    return true;
  }

  const Mesh& mesh() const {
    const Mesh& whole = reduction->mesh().mesh();
    if (!pairs) return whole;
    if (!both) both = pairs->both(whole);
    return *both;
  }
  std::uint64_t free_triangles() const {
    if (!pairs) return reduction->mesh().free_triangles();
    const std::vector<Triangle>& triangles = mesh().triangles;
    return static_cast<std::uint64_t>(std::count_if(
        triangles.begin(), triangles.end(),
        [&](const Triangle& t) { return t[0] >= locked && t[1] >= locked && t[2] >= locked; }));
  }
  double max_cost() const { return std::max(paid, reduction->mesh().max_cost()); }

  std::uint32_t locked;
  PositionType positions;
  LineOptions lines;
  bool may_be_paired;  // until pair_sheets() has looked
  std::unique_ptr<Reduction> reduction;
  std::vector<std::uint8_t> seam;
  Dropped dropped;
  double paid = 0;  // before the reduction
  std::optional<SheetPairs> pairs;
  SimplifyGoal asked{.triangles = UINT64_MAX, .max_cost = -1};
  mutable std::optional<Mesh> both;
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
bool Simplifier::has_free_border() const {
  return !impl_->pairs && impl_->reduction->mesh().has_free_border();
}
double Simplifier::max_cost() const {
  return impl_->max_cost();
}
double Simplifier::pass_cost() const {
  return impl_->reduction->mesh().pass_cost();
}
std::vector<Mesh> Simplifier::take_kept() {
  std::vector<Mesh> kept = impl_->reduction->take_kept();
  if (!impl_->pairs) return kept;
  for (Mesh& mesh : kept) mesh = impl_->pairs->both(mesh);
  return kept;
}
bool Simplifier::simplifies_topology() const {
  return impl_->reduction->end().simplifies_topology();
}
bool Simplifier::pairs_sheets() const {
  return impl_->pairs.has_value();
}
bool Simplifier::is_hampered_by_topology() const {
  return impl_->reduction->end().is_hampered();
}
std::uint64_t Simplifier::refused_by_topology() const {
  return impl_->reduction->end().refused_by_topology();
}
bool Simplifier::is_held_by_topology() const {
  return impl_->reduction->end().is_held();
}
bool Simplifier::is_slowed_by_topology() const {
  return impl_->reduction->is_slowed_by_topology();
}
std::uint64_t Simplifier::dropped_degenerate() const {
  return impl_->dropped.degenerate;
}
std::uint64_t Simplifier::dropped_duplicate() const {
  return impl_->dropped.duplicate;
}
std::uint64_t Simplifier::turned() const {
  return impl_->dropped.turned;
}
std::vector<std::uint32_t> Simplifier::opened() const {
  return impl_->reduction->mesh().opened();
}
std::span<const std::uint8_t> Simplifier::seam() const {
  return impl_->seam;
}

}  // namespace meshfarm
