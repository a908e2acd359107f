// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/io/bake_file.hpp>

#include "fuzz/staged_fuzzer.hpp"
#include "io/tiled_levels.hpp"

namespace {

constexpr std::uint32_t k_side = 64;

void paint(std::string_view file) {
  using namespace meshfarm;
  BakedCanvas canvas(k_side);
  canvas.add(decode_baked_texels(file, "texels"));
  canvas.finish(1);
}

void bake(std::string_view file) {
  using namespace meshfarm;
  const BakeSurface surface = decode_bake_surface(file, "chunk");
  BakedCanvas canvas(k_side);
  canvas.add(
      bake_texels(surface, {.texture_size = k_side, .threads = 1},
                  [](std::span<const Vec3>, std::span<const Vec3>, std::span<BakedColour> colours) {
                    std::fill(colours.begin(), colours.end(), BakedColour{});
                  }));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  fuzz::decode_staged(data, size, {'B', 'A', 'K', 'E'},
                      [](std::string_view file) { decode_bake_scene(file, "scene"); });
  fuzz::decode_staged(data, size, {'B', 'A', 'K', 'S'}, bake);
  fuzz::decode_staged(data, size, {'T', 'E', 'X', 'L'}, paint);
  fuzz::decode_staged(data, size, {'T', 'I', 'L', 'E'}, [](std::string_view file) {
    decode_tiled_pictures(file, "tiles", nullptr, std::make_shared<TileCache>(1));
  });
  return 0;
}
