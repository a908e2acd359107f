// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/divide/divided_surface.hpp>

#include "cli/command.hpp"

namespace meshfarm {

/// Options of commands that look at meshes of any size: --memory, --scratch, --threads.
struct MeasureWords {
  DivideOptions divide;

  void add(po::options_description& options);
  void check();

 private:
  std::string memory_ = "512M";
  std::string scratch_;
};

}  // namespace meshfarm
