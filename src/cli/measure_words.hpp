// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/divide/divided_surface.hpp>

#include "cli/command.hpp"

namespace meshfarm {

/// Options of commands that read meshes of any size: --memory, --scratch, --threads.
struct MeasureWords {
  DivideOptions divide;

  void add(po::options_description& options);
  void check();

 private:
  std::string memory_ = "512M";
  std::string scratch_;
};

/// Memory to hold a mesh and a hierarchy of its triangles.
std::uint64_t memory_to_hold(std::uint64_t vertices, std::uint64_t triangles);
/// Why something that needs this much memory is not done, and which --memory would be enough.
std::string why_too_little(std::uint64_t needed, std::uint64_t memory);

}  // namespace meshfarm
