// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// Raise this with every change that makes a job or the sink produce different bytes from the same
/// input and options, or that gives a run other jobs. It is part of the keys of jobs and runs and
/// of every greeting, so results of two versions never mix: older results in a stage are
/// recomputed, and processes of another version are refused.
inline constexpr std::uint32_t k_algorithm_version = 48;

}  // namespace meshfarm
