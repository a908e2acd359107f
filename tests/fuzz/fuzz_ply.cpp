// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "mesh_fuzzer.hpp"

/// A file of any format, by its content.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return meshfarm::fuzz::fuzz_mesh(
      data, size, [](const std::string& path) { return meshfarm::open_mesh(path); });
}
