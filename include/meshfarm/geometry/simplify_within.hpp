// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

namespace meshfarm {

/// Points of either surface that are farther from the other than they may be; nothing where there
/// are too many of them to name. What it finds must not change from call to call.
using FindStrays = std::function<std::optional<std::vector<Vec3>>(const Mesh&)>;

/// Simplifies by cost under a bound that a cost cannot tell, as one on the distance. Where a step
/// breaks it, the step is done again with the surroundings of these places locked as they were, so
/// that few bad places do not end the work everywhere.
class BoundedSimplifier {
 public:
  /// The options are those of a Simplifier, without seam. The mesh is taken to be good.
  BoundedSimplifier(Mesh mesh, SimplifyOptions options, FindStrays find_strays);

  using Progress = std::function<bool(std::uint64_t triangles_left)>;
  /// Collapses every edge up to this cost, but where that would break the bound. False, and nothing
  /// done, if it would break it in too many places. `progress` as in Simplifier::reduce.
  bool reduce(double max_cost, const Progress& progress = {});
  /// Of a mesh that may not be good, before anything else: the places that break the bound now stay
  /// as they are, and do not count from here on. False if they are too many.
  bool accept_strays();
  /// The cost at which it is worth to begin.
  double first_cost() const;

  /// Its first vertices are still those that were locked at first, in the same order.
  const Mesh& mesh() const { return mesh_; }
  std::uint64_t triangles() const { return mesh_.triangles.size(); }
  std::uint64_t dropped_degenerate() const { return dropped_degenerate_; }
  std::uint64_t dropped_duplicate() const { return dropped_duplicate_; }
  std::uint64_t turned() const { return turned_; }

 private:
  void drop_accepted(std::vector<Vec3>& strays) const;
  void lock_round(const std::vector<Vec3>& strays);
  bool is_accepted(const Triangle& triangle) const;
  void put_first(const std::vector<std::uint8_t>& flags);

  Mesh mesh_;
  SimplifyOptions options_;
  FindStrays find_strays_;
  std::uint32_t first_accepted_ = 0;  // vertices of places that were bad from the start
  std::uint32_t end_accepted_ = 0;
  std::uint64_t dropped_degenerate_ = 0;
  std::uint64_t dropped_duplicate_ = 0;
  std::uint64_t turned_ = 0;
};

/// Reduces by rising costs until the bound is broken in too many places or nothing more goes, to
/// within a factor of `last_step` of that cost; `tell` is told the triangles left. Returns the cost
/// that was reached.
double reduce_to_bound(BoundedSimplifier& simplifier, double last_step,
                       const BoundedSimplifier::Progress& tell = {});

}  // namespace meshfarm
