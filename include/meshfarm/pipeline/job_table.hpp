// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

/// Does a job by the function of its kind: the only place where the farm's jobs meet the mesh code.
/// Throws DataError for a kind unknown to this program.
JobOutput do_job(const Job& job, const JobContext& context);

/// Throws DataError if the run can't continue from this output of a job of that kind, because its
/// summary cannot be read.
void check_output(std::string_view kind, const JobOutput& output);

}  // namespace meshfarm
