// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>

#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/collapse_drift.hpp"
#include "geometry/simplify/crossing_guard.hpp"
#include "geometry/simplify/simplify_rank.hpp"
#include "geometry/simplify/working_mesh.hpp"

namespace meshfarm {

/// Passes that each rank all edges and take the cheapest share of them, while the goal is not near.
class RankedPasses {
 public:
  enum class End : std::uint8_t {
    near,       // the rest is to be done in order
    exhausted,  // little is left that costs no more than the goal allows
    dead_end,   // cheap edges are refused
    told        // progress said stop
  };

  /// `bound` may be null.
  RankedPasses(WorkingMesh& mesh, const SurfaceBound* bound);

  End reduce(const SimplifyGoal& goal, const std::function<bool(std::uint64_t)>& progress);
  /// Simplifier::is_slowed_by_topology, of the last reduce().
  bool is_slowed_by_topology() const;
  /// Whether the last pass could do nearly all that it tried, and many triangles are left.
  bool refuses_little() const;

 private:
  struct Pass {
    CostKey limit = k_any_cost;
    double max_cost = 0;      // the lower of the goal's and what the limit stands for
    std::uint32_t block = 0;  // vertices whose edges are ranked and collapsed together
  };

  bool is_near(const SimplifyGoal& goal) const;
  Pass plan(const SimplifyGoal& goal);
  std::uint64_t run(const SimplifyGoal& goal, const Pass& pass);
  bool may_drift(DriftMeter& meter, const RankedEdge& edge, const Collapse& collapse);
  bool is_too_rough(const SimplifyGoal& goal, const Pass& pass) const;
  void renumber_drifts();

  WorkingMesh& mesh_;
  const SurfaceBound* bound_;
  std::vector<float> drifts_;  // of each vertex, where there is a bound
  EdgeRanking ranking_;
  // Ranks by lower bounds, so that flat regions go before nearly flat ones. Where few flat
  // ones are left, most edges that rank low cost more and are refused.
  bool ranks_by_bounds_ = true;
  bool ranks_finely_ = false;                   // most edges that rank low are flat but for noise
  std::uint64_t all_collapses_ = 0;             // of the last reduce()
  std::uint64_t all_refused_for_topology_ = 0;  // in the last reduce()
  std::uint64_t tried_ = 0;                     // edges in the last pass
  std::uint64_t collapses_ = 0;                 // of the last pass
  std::uint64_t refused_for_topology_ = 0;      // in the last pass
  std::uint64_t refused_for_bound_ = 0;         // in the last pass
};

}  // namespace meshfarm
