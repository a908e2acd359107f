// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>

#include "mesh_fuzzer.hpp"

namespace {

using meshfarm::Textures;

// In /proc/self/fd a file's name is its number.
constexpr int k_picture = 101;

/// A PNG of one texel.
constexpr std::array<unsigned char, 69> k_png{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
    0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0xf8, 0xff, 0xff, 0x3f, 0x00, 0x05, 0xfe, 0x02, 0xfe, 0x0d, 0xef, 0x46,
    0xb8, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

meshfarm::Fd open_picture() {
  const meshfarm::Fd file(::memfd_create("beside", MFD_CLOEXEC));
  meshfarm::fuzz::require(bool(file));
  meshfarm::write_all(file.get(), {reinterpret_cast<const char*>(k_png.data()), k_png.size()},
                      "memfd");
  meshfarm::Fd made(::dup2(file.get(), k_picture));
  meshfarm::fuzz::require(bool(made));
  return made;
}

}  // namespace

/// A file of any format, recognised by its content. Its textures can refer to the picture "101".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const meshfarm::Fd picture = open_picture();
  for (const Textures textures : {Textures::drop, Textures::keep, Textures::bake}) {
    const int used = meshfarm::fuzz::fuzz_mesh(data, size, [textures](const std::string& path) {
      auto source = meshfarm::open_mesh(path, {.textures = Textures::name});
      // A triangle can cover any number of texels.
      constexpr std::uint64_t k_most_sampled = 1 << 9;
      if (textures == Textures::bake && source->info().faces > k_most_sampled) return source;
      return meshfarm::open_mesh(path, {.textures = textures});
    });
    if (used != 0) return used;
  }
  return 0;
}
