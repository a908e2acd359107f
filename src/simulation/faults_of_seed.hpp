// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/simulation/simulated_faults.hpp>

namespace meshfarm {

/// A mix of faults drawn from the seed: each kind is absent, rare or frequent.
SimulatedFaults faults_of_seed(std::uint64_t seed);

}  // namespace meshfarm
