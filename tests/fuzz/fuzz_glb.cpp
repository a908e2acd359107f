// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "io/gltf_reader.hpp"
#include "mesh_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return meshfarm::fuzz::fuzz_mesh(data, size, [](const std::string& path) {
    meshfarm::InputFile file(path);
    // Textures are named, not sampled: a small picture may have any number of texels.
    const meshfarm::OpenOptions options{.textures = meshfarm::Textures::name};
    std::unique_ptr<meshfarm::MeshSource> source =
        meshfarm::is_glb_file(file) ? meshfarm::open_glb(std::move(file), options)
                                    : meshfarm::open_gltf(std::move(file), options);
    // Some nodes and primitives may show one mesh any number of times.
    constexpr std::uint64_t k_most = 1 << 20;
    if (std::max(source->info().vertices, source->info().faces) > k_most) {
      throw meshfarm::DataError("too large to be scanned in time");
    }
    return source;
  });
}
