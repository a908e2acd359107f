// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/divide/divided_surface.hpp>
#include <meshfarm/geometry/distance.hpp>

namespace meshfarm {

/// As measure_distance of two meshes does, of surfaces of any size: from 2/3 to 4/3 as many points
/// as are asked for, in about 100 bytes a point beside what is shown at a time. Throws DataError if
/// either has no triangle of positive area.
Distance measure_distance(const DividedSurface& from, const DividedSurface& to,
                          const DistanceOptions& options);

}  // namespace meshfarm
