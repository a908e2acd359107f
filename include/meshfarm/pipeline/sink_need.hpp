// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// What the sink of a run has to hold at once, estimated before the first job.
struct SinkNeed {
  std::uint64_t triangles = 0;  // of the stitched mesh
  std::uint64_t bytes = 0;
};

/// Nothing if a bound on the error decides how much is left.
std::optional<SinkNeed> sink_need(const Manifest& manifest, const RunOptions& options);

/// Throws UsageError if the sink could not hold it anywhere, as its indices have 32 bits. Otherwise
/// returns advice if it exceeds these free bytes; empty if it fits, or if the free memory is not
/// known.
std::string check_sink_need(const Manifest& manifest, const RunOptions& options,
                            std::optional<std::uint64_t> free_bytes);

}  // namespace meshfarm
