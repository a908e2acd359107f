// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Measures what a part becomes against the part as it came, in both directions, on one thread.
/// Keeps the part.
class PartError {
 public:
  /// `samples`: of the part's surface.
  PartError(Mesh part, const SurfaceSamples& samples);
  /// Points of either surface, vertices among them, that are farther than the bound from the other;
  /// nothing where they are too many.
  std::optional<std::vector<Vec3>> strays(const Mesh& simplified, double bound) const;

 private:
  Mesh part_;
  std::vector<Vec3> vertices_;  // and middles of sides
  std::vector<Vec3> surface_;
  double spacing_ = 0;
};

}  // namespace meshfarm
