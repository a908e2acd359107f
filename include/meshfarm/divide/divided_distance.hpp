// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/divide/divided_surface.hpp>
#include <meshfarm/geometry/value_error.hpp>

namespace meshfarm {

/// As measure_error of two meshes does, but distances only, of surfaces of any size: from 2/3 to
/// 4/3 as many points as are asked for, in about 100 bytes a point beside what is shown at a time.
/// Throws DataError if either has no triangle of positive area.
SurfaceError measure_error(const DividedSurface& from, const DividedSurface& to,
                           const DistanceOptions& options);

}  // namespace meshfarm
