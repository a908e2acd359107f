// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm {

/// About `jobs` jobs, which follow each other as those of a run that cuts its input and finishes
/// its result by jobs (pipeline/run_graph.hpp): blocks are surveyed, counted twice, partitioned and
/// scattered; parts are climbed, some again; the sink joins their boundary; pieces are split twice,
/// with a seam each time, reduced, some again, and measured. A job's output depends on the outputs
/// of all that it needs. Runs with different targets share the cut.
JobSource whole_run(std::uint64_t jobs, const std::string& target = "");

}  // namespace meshfarm
