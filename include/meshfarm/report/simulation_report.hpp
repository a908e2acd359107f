// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>

namespace meshfarm {

/// The output of `simulate --seeds`: the simulated histories.
struct SeedsSummary {
  struct Problem {
    std::uint64_t seed = 0;
    std::string what;
  };
  std::uint64_t seeds = 0;
  std::uint32_t workers = 0;
  std::uint64_t jobs = 0;
  std::string graph = "run";  // the words for --graph
  std::uint64_t events = 0;
  double virtual_s = 0;
  double wall_s = 0;
  std::uint64_t trace_hash = 0;
  std::vector<Problem> problems;
};

std::string render(const SeedsSummary& summary, Format format);

}  // namespace meshfarm
