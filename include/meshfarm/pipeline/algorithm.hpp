// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// To be raised with every change after which a job, or the sink, makes other bytes of the same
/// input and options, or a run has other jobs. It stands in the keys of jobs and runs and in every
/// greeting, so that results of two versions never meet: older ones in a stage are done again,
/// processes of another are refused.
inline constexpr std::uint32_t k_algorithm_version = 40;

}  // namespace meshfarm
