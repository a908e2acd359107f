// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// dynamic: jobs go to whoever will have done them first. fixed: all jobs are dealt out at the
/// start in sets of equal estimated time (Xiong et al. 2008, 3.2.1: the baseline of the paper).
enum class Schedule : std::uint8_t { dynamic, fixed };

struct SchedulerOptions {
  Schedule schedule = Schedule::dynamic;
  std::uint32_t expect_workers = 1;  // a fixed schedule is dealt out once so many are there
  FarmTime horizon{2000};            // a full input buffer is worth so much time on every worker
};

}  // namespace meshfarm
