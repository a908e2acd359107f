// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// What a worker did until it left.
struct WorkerReport {
  std::uint64_t jobs_done = 0;
  std::uint64_t jobs_failed = 0;
  double span_seconds = 0;     // from the start of the first job to the end of the last
  double compute_seconds = 0;  // of all threads within that span
};

}  // namespace meshfarm
