// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/simplify/collapse.hpp"

namespace meshfarm {

/// Tells by and large how far a collapse moves the surface: from points of the triangles that were
/// to those that it makes, and back.
class DriftMeter {
 public:
  explicit DriftMeter(const CollapseState& state) : state_(state) {}
  /// The greatest of these distances; those below `least` are not told apart.
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
