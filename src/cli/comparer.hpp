// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <meshfarm/divide/divided_surface.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/report/summary.hpp>

namespace meshfarm {

struct CompareOptions {
  DivideOptions divide;      // its memory is for both meshes, its threads for everything
  DistanceOptions distance;  // but for its threads
  bool certify = false;      // bound the maximum distances over all points
  std::string map;           // where to write B with its vertices' distances from A; may be empty
};

/// The channels of a map besides its positions.
std::vector<Channel> distance_channels();

/// Measures two mesh files of any size. Measures that need both meshes in memory are left out if
/// they do not fit, and the comparison says so; requested maps or bounds are then a UsageError.
Comparison compare_meshes(const std::string& path_a, const std::string& path_b,
                          const CompareOptions& options);

}  // namespace meshfarm
