// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

inline constexpr std::string_view k_sweep_kind = "sweep";

/// Parameters of a sweep job.
struct SweepParameters {
  std::int32_t level = 0;              // of the single rung that is made
  double max_cost = 0;                 // the cost of the level; below 0: nothing is collapsed
  double ratio = 0;                    // where above 0: the share of each window that is kept
  std::uint64_t window_triangles = 0;  // of the buffer
  std::uint64_t samples = 0;           // points of the stream to measure the final error by
  double max_error = 0;                // where above 0: the result's error is measured
  LineOptions lines;
};

std::string encode_parameters(const SweepParameters& parameters);
SweepParameters decode_sweep_parameters(std::string_view bytes);

/// Simplifies a long stream (the job's input) in one pass, to a result of one rung. The stream is
/// read incrementally unless it is so short that a worker may read it ahead; the result is written
/// as the sweep proceeds, so it may be larger than the memory.
JobOutput sweep_stream(const Job& job, const JobContext& context);

}  // namespace meshfarm
