// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>

namespace meshfarm {

struct BoundedPart {
  std::string file;  // a result of one rung
  ResultSummary summary;
};

/// Simplifies a part as far as possible with no distance between result and part above
/// SimplifyParameters::max_error, in either direction. `beside`: stored in the file beside its
/// mesh.
BoundedPart simplify_to_bound(const Part& part, const SimplifyParameters& parameters,
                              const JobContext& context, std::string_view beside = {});

}  // namespace meshfarm
