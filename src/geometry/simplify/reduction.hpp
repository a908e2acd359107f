// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/ordered_end.hpp"
#include "geometry/simplify/ranked_passes.hpp"
#include "geometry/simplify/working_mesh.hpp"

namespace meshfarm {

/// One mesh on its way to a goal: rough passes far from it, then ranked ones, and the last part of
/// the way in order.
class Reduction {
 public:
  using Progress = std::function<bool(std::uint64_t)>;

  Reduction(Mesh input, const SimplifyOptions& options);
  Reduction(const Reduction&) = delete;
  Reduction& operator=(const Reduction&) = delete;

  /// As Simplifier::reduce.
  void reduce(const SimplifyGoal& goal, const Progress& progress);
  /// Done once, for the first goal. Returns the thickness up to which walls are flagged; 0 where
  /// crossings are allowed.
  double flag_thin_walls(const SimplifyGoal& goal);

  const WorkingMesh& mesh() const { return mesh_; }
  const OrderedEnd& end() const { return end_; }
  std::vector<Mesh> take_kept() { return end_.take_kept(); }
  bool is_slowed_by_topology() const { return end_.has_begun() || passes_.is_slowed_by_topology(); }

 private:
  bool reduce_roughly(const SimplifyGoal& goal, const Progress& progress);
  bool is_healthy(std::uint64_t before, const SimplifyGoal& goal) const;

  WorkingMesh mesh_;
  TopologyMode topology_;
  const SurfaceBound* bound_;
  bool may_be_rough_;  // until a rough pass has done nothing
  bool in_order_;      // passes have ended, or would take expensive edges
  RankedPasses passes_;
  OrderedEnd end_;
  double thickness_ = -1;       // of thin walls, when they are flagged
  double exhausted_cost_ = -1;  // nothing is left that costs at most this
};

}  // namespace meshfarm
