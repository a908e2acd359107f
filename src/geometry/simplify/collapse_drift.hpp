// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/simplify/collapse.hpp"

namespace meshfarm {

/// Estimates how far a collapse moves the surface: from points of the old triangles to the new
/// ones, and back.
class DriftMeter {
 public:
  explicit DriftMeter(const CollapseState& state) : state_(state) {}
  /// The greatest of these distances, or `least` if they are smaller.
  double drift_of(std::uint32_t a, std::uint32_t b, Vec3 position, double least);

 private:
  struct Facet {
    Vec3 first, next, prev;
  };

  void list_star(std::uint32_t a, std::uint32_t b, Vec3 position);

  CollapseState state_;
  std::vector<Facet> were_;
  std::vector<Facet> made_;
};

}  // namespace meshfarm
