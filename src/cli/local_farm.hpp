// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "cli/options.hpp"
#include "cli/output_words.hpp"

namespace meshfarm {

/// Parameters for the processes of one run on this machine.
struct LocalFarm {
  std::string stage;
  std::string output;
  const OutputWords& words_of_output;
  const TargetOptions& target;
  const NetworkOptions& network;
  const ScheduleWords& schedule;
  const FullWords& when_full;
  const TalkOptions& talk;
  std::uint32_t workers = 0;
};

/// Runs ventilator, sink and workers on this machine until they end. Returns the exit code of the
/// run.
int run_local_farm(const LocalFarm& farm, const std::atomic<bool>& stop);

/// One worker per core.
std::uint32_t default_workers();

}  // namespace meshfarm
