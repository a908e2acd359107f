// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/geometry/sweep_order.hpp>

namespace meshfarm {

inline constexpr std::string_view k_sort_kind = "sort";
inline constexpr std::string_view k_sample_kind = "sample";

/// Parameters of a sort job, and of a sample job.
struct SortParameters {
  Sorting sorting;
  std::uint32_t number = 0;  // of the stream: decides where its sample is taken; 0 to sort
};

std::string encode_parameters(const SortParameters& parameters);
SortParameters decode_sort_parameters(std::string_view bytes);

/// What must be known of a stream or a sample without reading it: sent with the result message.
struct SortSummary {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint32_t boundary_vertices = 0;
  std::uint64_t coincident_vertices = 0;  // none of a sample
  std::uint64_t dropped_degenerate = 0;   // none of a sample
  std::uint64_t coincident_corners = 0;   // none of a sample
};

std::string encode_summary(const SortSummary& summary);
SortSummary decode_sort_summary(std::string_view bytes, std::string_view what);

/// Sorts a slab (the job's input) to a stream (Xiong et al. 2008, 4.1), to the same bytes that the
/// cut publishes when it does the sorting.
JobOutput sort_to_stream(const Job& job, const JobContext& context);

/// Takes a sample of a long stream (the job's input): a part, with the same bytes that the cut
/// publishes.
JobOutput sample_stream(const Job& job, const JobContext& context);

}  // namespace meshfarm
