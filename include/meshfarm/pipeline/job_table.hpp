// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

/// Does a job by the function of its kind: the one place where the farm's jobs meet the mesh code.
/// Throws DataError for a kind that this program does not know.
JobOutput do_job(const Job& job, const JobContext& context);

}  // namespace meshfarm
