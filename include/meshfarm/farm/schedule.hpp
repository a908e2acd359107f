// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// dynamic: jobs go to whoever is estimated to finish them first. fixed: all jobs are dealt out at
/// the start in sets of equal estimated time (Xiong et al. 2008, 3.2.1: the paper's baseline).
enum class Schedule : std::uint8_t { dynamic, fixed };

struct SchedulerOptions {
  Schedule schedule = Schedule::dynamic;
  std::uint32_t expect_workers = 1;  // a fixed schedule is dealt out once this many have joined
  FarmTime horizon{2000};            // how long a full input buffer lasts, on every worker
};

}  // namespace meshfarm
