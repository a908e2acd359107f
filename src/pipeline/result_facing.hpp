// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

#include "pipeline/error_meter.hpp"

namespace meshfarm {

/// Mends triangles of a result that face away from the nearest point of the input, if that is
/// possible locally (repair_facing). Reads the input once if surfaces are near each other anywhere,
/// and reads and holds what is near such triangles once more.
FacingMended mend_facing(Mesh& result, const ErrorMeter& meter, const Stage& stage,
                         const Manifest& manifest, unsigned threads);

}  // namespace meshfarm
