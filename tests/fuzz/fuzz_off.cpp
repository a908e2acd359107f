// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "io/ply_reader.hpp"
#include "mesh_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return meshfarm::fuzz::fuzz_mesh(data, size, [](const std::string& path) {
    meshfarm::InputFile file(path);
    if (!meshfarm::is_off_file(file)) throw meshfarm::DataError("no OFF");
    return meshfarm::open_off(std::move(file), {.threads = 2});
  });
}
