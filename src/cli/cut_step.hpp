// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/partition/cut.hpp>

#include "cli/options.hpp"

namespace meshfarm {

struct CutStep {
  std::string input;
  std::string stage;
  CutOptions cut;
  const TalkOptions& talk;
  const std::atomic<bool>& stop;
};

/// Cuts a file into a stage that holds no manifest yet, with progress on stderr.
Manifest cut_to_stage(const CutStep& step);

/// Throws IoError now rather than after an hour's work if `output` cannot be made.
void check_writable(const std::string& output);

}  // namespace meshfarm
