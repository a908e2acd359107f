// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "io/gltf_reader.hpp"
#include "mesh_fuzzer.hpp"

namespace {

std::unique_ptr<meshfarm::MeshSource> open_any(const std::string& path,
                                               const meshfarm::OpenOptions& options) {
  meshfarm::InputFile file(path);
  return meshfarm::is_glb_file(file) ? meshfarm::open_glb(std::move(file), options)
                                     : meshfarm::open_gltf(std::move(file), options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A few nodes and primitives can repeat one mesh any number of times.
  const auto count = [](const meshfarm::MeshSource& source) {
    constexpr std::uint64_t k_most = 1 << 20;
    const std::uint64_t most = std::max(source.info().vertices, source.info().faces);
    if (most > k_most) throw meshfarm::DataError("too large to be scanned in time");
    return most;
  };
  const int used = meshfarm::fuzz::fuzz_mesh(data, size, [count](const std::string& path) {
    auto source = open_any(path, {.textures = meshfarm::Textures::keep});
    count(*source);
    return source;
  });
  if (used != 0) return used;
  return meshfarm::fuzz::fuzz_mesh(data, size, [count](const std::string& path) {
    auto source = open_any(path, {.textures = meshfarm::Textures::name});
    const std::uint64_t most = count(*source);
    // A small picture can have any number of texels, and so can a triangle.
    constexpr std::uint64_t k_most_sampled = 1 << 9;
    if (source->info().textures.empty() || most > k_most_sampled) return source;
    return open_any(path, {.textures = meshfarm::Textures::bake,
                           .picture_bytes = meshfarm::fuzz::k_most_picture_bytes});
  });
}
