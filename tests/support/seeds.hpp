// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <doctest/doctest.h>

namespace meshfarm::test {

/// The fuzzers start from these files: seeds of an older format would never get past its first
/// bytes. MESHFARM_WRITE_SEEDS=1 rewrites them.
inline void check_seed(const std::string& fuzzer, const std::string& name,
                       const std::string& bytes) {
  const auto path =
      std::filesystem::path(MESHFARM_SOURCE_DIR) / "tests/fuzz/corpus" / fuzzer / name;
  CAPTURE(path.string());
  if (std::getenv("MESHFARM_WRITE_SEEDS") != nullptr) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  std::ifstream file(path, std::ios::binary);
  const std::string seed{std::istreambuf_iterator<char>(file), {}};
  CHECK((seed == bytes));
}

}  // namespace meshfarm::test
