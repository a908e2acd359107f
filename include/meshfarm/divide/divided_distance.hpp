// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/divide/divided_surface.hpp>
#include <meshfarm/geometry/value_error.hpp>

namespace meshfarm {

/// Like measure_error of two meshes, but distances only, for surfaces of any size: uses 2/3 to 4/3
/// of the number of points asked for. Memory: about 100 bytes per point, besides the piece shown at
/// a time. Throws DataError if either surface has no triangle of positive area.
SurfaceError measure_error(const DividedSurface& from, const DividedSurface& to,
                           const DistanceOptions& options);

}  // namespace meshfarm
