// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshoptimizer.h>

namespace meshfarm::bench {

/// The header counts in thousandths: 180 is version 0.18.
inline std::string meshoptimizer_version() {
  const int major = MESHOPTIMIZER_VERSION / 1000;
  const int minor = MESHOPTIMIZER_VERSION % 1000 / 10;
  return std::to_string(major) + "." + std::to_string(minor);
}

}  // namespace meshfarm::bench
