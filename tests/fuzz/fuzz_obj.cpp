// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string_view>

#include "io/obj_reader.hpp"
#include "mesh_fuzzer.hpp"

namespace {

// In /proc/self/fd a file's name is its number.
constexpr int k_library = 100;
constexpr int k_picture = 101;

/// An empty file if `bytes` is empty.
meshfarm::Fd open_as(int number, std::string_view bytes) {
  const meshfarm::Fd file(::memfd_create("beside", MFD_CLOEXEC));
  meshfarm::fuzz::require(bool(file));
  meshfarm::write_all(file.get(), bytes, "memfd");
  meshfarm::Fd made(::dup2(file.get(), number));
  meshfarm::fuzz::require(bool(made));
  return made;
}

}  // namespace

// An OBJ, then after a zero byte the library "100", and after another one the picture "101".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::string_view mesh = all.substr(0, all.find('\0'));
  std::string_view rest = all.substr(std::min(size, mesh.size() + 1));
  const std::string_view library = rest.substr(0, rest.find('\0'));
  rest.remove_prefix(std::min(rest.size(), library.size() + 1));
  const meshfarm::Fd library_file = open_as(k_library, library);
  const meshfarm::Fd picture_file = open_as(k_picture, rest);
  const int used = meshfarm::fuzz::fuzz_mesh(data, mesh.size(), [](const std::string& path) {
    return meshfarm::open_obj(meshfarm::InputFile(path),
                              {.threads = 2, .textures = meshfarm::Textures::keep});
  });
  if (used != 0) return used;
  return meshfarm::fuzz::fuzz_mesh(data, mesh.size(), [](const std::string& path) {
    auto source = meshfarm::open_obj(meshfarm::InputFile(path),
                                     {.threads = 2, .textures = meshfarm::Textures::name});
    // A small picture can have any number of texels, and so can a triangle.
    constexpr std::uint64_t k_most_sampled = 1 << 9;
    if (source->info().textures.empty() || source->info().faces > k_most_sampled) return source;
    return meshfarm::open_obj(meshfarm::InputFile(path),
                              {.threads = 2,
                               .textures = meshfarm::Textures::bake,
                               .picture_bytes = meshfarm::fuzz::k_most_picture_bytes});
  });
}
