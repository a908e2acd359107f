// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>

namespace meshfarm {

/// The result for each file of a batch.
struct BatchReport {
  enum class State : std::uint8_t { done, done_before, failed, stopped };
  struct File {
    std::string input;
    std::string output;
    State state = State::stopped;
    std::string reason;   // why it failed
    std::string summary;  // of its run, as JSON; may be empty
    double seconds = 0;
  };
  std::vector<File> files;
};

std::string render(const BatchReport& report, Format format);

}  // namespace meshfarm
