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
  DivideOptions divide;      // its memory is for both meshes, its threads for all
  DistanceOptions distance;  // but for its threads
  bool certify = false;      // bound the greatest distances over all points
  std::string map;           // B with its vertices' distances from A is written there; may be empty
};

/// What a map has beside its positions.
std::vector<Channel> distance_channels();

/// Measures two mesh files of any size. What takes both in memory is left out where they do not
/// fit, and the comparison says so; but a map or bounds that were asked for are a UsageError then.
Comparison compare_meshes(const std::string& path_a, const std::string& path_b,
                          const CompareOptions& options);

}  // namespace meshfarm
