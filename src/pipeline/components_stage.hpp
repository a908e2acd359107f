// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>

#include "pipeline/compose_stage.hpp"

namespace meshfarm {

/// The job that finds which components of the pieces are to be left out.
Job components_job(const Manifest& manifest, const RunOptions& options,
                   const std::vector<ComposedParts>& pieces);

}  // namespace meshfarm
