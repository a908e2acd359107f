// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/simplify_queue.hpp"
#include "geometry/simplify/working_mesh.hpp"

namespace meshfarm {

/// The last part of the way: edges collapse strictly in order of their cost. Decides whether the
/// topology is kept, where that is left open.
class OrderedEnd {
 public:
  /// `bound` may be null.
  OrderedEnd(WorkingMesh& mesh, TopologyMode topology, const SurfaceBound* bound);
  ~OrderedEnd();
  OrderedEnd(OrderedEnd&&) noexcept;

  /// Once it has begun, only this changes the mesh.
  bool has_begun() const { return trial_ != nullptr; }
  /// Returns the cost up to which no edge is left that could collapse, if that was reached.
  std::optional<double> reduce(const SimplifyGoal& goal,
                               const std::function<bool(std::uint64_t)>& progress);

  std::vector<Mesh> take_kept();
  bool simplifies_topology() const;
  bool is_held() const;
  std::uint64_t refused_by_topology() const;
  bool is_hampered() const;

 private:
  struct Trial;
  struct Rival;

  bool cannot_keep(const SimplifyGoal& goal) const;
  bool is_held_near(const SimplifyGoal& goal) const;
  bool must_decide(const SimplifyGoal& goal);
  bool refuses_much() const;
  bool is_costly_to_keep(const SimplifyGoal& goal) const;
  double share_paid_before(const CollapseQueue& other) const;
  bool is_unfair(const CollapseQueue& other, const SimplifyGoal& goal) const;

  WorkingMesh& mesh_;
  TopologyMode topology_;
  const SurfaceBound* bound_;
  std::unique_ptr<Trial> trial_;
  std::uint64_t taken_ = UINT64_MAX;       // collapses of the trial that the mesh has taken over
  std::uint64_t decided_at_ = UINT64_MAX;  // triangles left at the last decision on the topology
};

}  // namespace meshfarm
