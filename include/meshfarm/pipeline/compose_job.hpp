// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

inline constexpr std::string_view k_compose_kind = "compose";

/// One of the results that a compose job joins.
struct ComposeInput {
  std::uint32_t parts = 1;  // already joined in it
  std::uint32_t rung = 0;
};

/// Parameters of a compose job.
struct ComposeParameters {
  std::uint32_t first_part = 0;
  std::uint32_t all_parts = 0;       // of the stage
  std::vector<ComposeInput> inputs;  // one per input of the job, in the order of the parts
  BoundaryFiles boundary;            // not inputs, as they are not read whole
  std::int32_t level = 0;            // of the single rung that is made
  double max_cost = 0;               // the cost of the level
  std::uint64_t floor = 0;           // triangles to leave
  double samples_per_triangle = 0;   // of the seams, to measure the final error by
  bool keeps_between = false;        // the input's triangles between the parts, to measure to them
  LineOptions lines;
};

std::string encode_parameters(const ComposeParameters& parameters);
ComposeParameters decode_compose_parameters(std::string_view bytes);

/// Joins the results of neighbours by the boundary triangles between them (Xiong et al. 2008, 4.3)
/// and simplifies what was locked there, under the same cost threshold as the parts. Whatever the
/// group shares with parts outside it stays unchanged. Only the regions of the boundary side file
/// that the group touches are read. The triangles kept are stored beside the result as a surface
/// (piece_sections.hpp).
JobOutput compose_parts(const Job& job, const JobContext& context);

}  // namespace meshfarm
