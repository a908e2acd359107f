// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>

namespace meshfarm {

/// What `clean` removed from a stage, and what it kept for whom.
struct CleanReport {
  struct Removed {
    std::string what;
    std::uint64_t files = 0;
    std::uint64_t bytes = 0;
  };
  std::string stage;
  bool dry_run = false;          // nothing was removed, only listed
  std::vector<Removed> removed;  // each kind once
  std::vector<std::string> kept;
};

std::string render(const CleanReport& report, Format format);

}  // namespace meshfarm
