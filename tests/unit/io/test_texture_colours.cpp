// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/memory.hpp>

#include "io/texture_colours.hpp"
#include "picture_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::array<TexturePoint, 3> k_coloured_places{{{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}}};

TextureImage image_of(const Texel& texel) {
  return {"one", [bytes = png_of(picture_of(16, 16, [texel](auto, auto) { return texel; }))] {
            return bytes;
          }};
}

TextureImage lost_image() {
  return {"lost", []() -> std::string { throw DataError("it is not there"); }};
}

struct Sampled {
  std::size_t pictures = 0;
  int scans = 0;
  std::vector<std::optional<LinearColour>> colours;
};

/// Samples a triangle per material, each with its own vertices, and a vertex without any.
Sampled sample(const std::vector<TextureImage>& images,
               const std::vector<TextureMaterial>& materials,
               const TextureColours::Options& options) {
  Sampled made;
  TextureColours colours(3 * materials.size() + 1, "m");
  made.pictures = colours.sample(
      images, materials, options,
      [&](const TextureColours::IsWanted&, const TextureColours::Add& add) {
        ++made.scans;
        for (std::size_t i = 0; i < materials.size(); ++i) {
          add({.vertices = {3 * i, 3 * i + 1, 3 * i + 2}, .places = k_coloured_places}, i);
        }
      });
  for (std::size_t v = 0; v <= 3 * materials.size(); ++v) made.colours.push_back(colours.of(v));
  return made;
}

const std::vector<TextureMaterial> k_coloured_materials{
    {.image = 0}, {.image = 1}, {.image = 2, .plain = {0.25F, 0, 0}}, {.plain = {0, 0.5F, 0}}};

}  // namespace

TEST_CASE("pictures are held as many at a time as the memory allows, to the same colours") {
  const std::vector<TextureImage> images{image_of({255, 0, 0}), image_of({0, 255, 0}),
                                         lost_image()};
  const Sampled at_once = sample(images, k_coloured_materials, {});
  CHECK(at_once.pictures == 2);
  CHECK(at_once.scans == 2);  // one for the pictures, one for what has none
  const Sampled one_by_one = sample(images, k_coloured_materials, {.memory_bytes = 1});
  CHECK(one_by_one.scans == 3);
  CHECK(one_by_one.colours == at_once.colours);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(at_once.colours[i] == LinearColour{1, 0, 0});
    CHECK(at_once.colours[3 + i] == LinearColour{0, 1, 0});
    CHECK(at_once.colours[6 + i] == LinearColour{0.25F, 0, 0});
    CHECK(at_once.colours[9 + i] == LinearColour{0, 0.5F, 0});
  }
  CHECK_FALSE(at_once.colours.back());
}

TEST_CASE("what has no picture is left to itself where that is asked for") {
  const std::vector<TextureImage> images{image_of({255, 0, 0}), lost_image(), lost_image()};
  const Sampled made = sample(images, k_coloured_materials, {.plain = TextureColours::Plain::left});
  CHECK(made.pictures == 1);
  CHECK(made.scans == 1);
  CHECK(made.colours[0] == LinearColour{1, 0, 0});
  for (std::size_t v = 3; v < made.colours.size(); ++v) CHECK_FALSE(made.colours[v]);
}

TEST_CASE("without any picture nothing is coloured, and nothing scanned") {
  const Sampled made = sample({lost_image(), lost_image(), lost_image()}, k_coloured_materials, {});
  CHECK(made.pictures == 0);
  CHECK(made.scans == 0);
  CHECK_FALSE(made.colours[9]);
}

TEST_CASE("a vertex counts its triangles by their areas on the texture") {
  const Picture halves = picture_of(64, 64, [](std::uint32_t x, auto) {
    return x < 32 ? Texel{255, 0, 0} : Texel{0, 255, 0};
  });
  TextureColours colours(5, "m");
  const auto scan = [](const TextureColours::IsWanted&, const TextureColours::Add& add) {
    add({.vertices = {0, 1, 2}, .places = {{{0, 0}, {0.25, 0}, {0, 0.75}}}}, 0);
    add({.vertices = {0, 3, 4}, .places = {{{1, 0}, {0.75, 0}, {1, 0.25}}}}, 0);
  };
  const std::vector<TextureImage> images{{"halves", [&] { return png_of(halves); }}};
  CHECK(colours.sample(images, {{.image = 0}}, {}, scan) == 1);
  const auto shared = colours.of(0);
  REQUIRE(shared);
  CHECK((*shared)[0] == doctest::Approx(0.75));
  CHECK((*shared)[1] == doctest::Approx(0.25));
}

namespace {

/// A PNG with alpha that ends where its texels would begin.
TextureImage claimed(std::uint32_t side) {
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  for (int of_two = 0; of_two < 2; ++of_two) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(side >> shift);
  }
  bytes += std::string("\x08\x06\0\0\0\0\0\0\0", 9);
  return {"large", [bytes] { return bytes; }};
}

}  // namespace

TEST_CASE("a picture that takes more memory than it may is refused before it is decoded") {
  const std::vector<TextureMaterial> materials{{.image = 0}};
  const TextureColours::Options options{.picture_bytes = std::uint64_t{12} << 20};
  CHECK_THROWS_WITH_AS(sample({claimed(2000)}, materials, options),
                       "m: the texture large takes 15 MiB of memory, more than the 12 MiB that it "
                       "may take: make it smaller, or leave textures out with --uv drop",
                       DataError);
  CHECK(sample({claimed(1000)}, materials, options).pictures == 0);  // damaged
  CHECK(sample({image_of({255, 0, 0})}, materials, options).pictures == 1);
}

TEST_CASE("without another limit a picture may take half of the memory that is free") {
  const std::vector<TextureMaterial> materials{{.image = 0}};
  const std::optional<MemoryRoom> room = available_memory();
  constexpr std::uint64_t k_bytes = std::uint64_t{32'000} * 32'000 * 4;
  if (room && k_bytes > room->bytes) {
    CHECK_THROWS_WITH_AS(sample({claimed(32'000)}, materials, {}),
                         doctest::Contains("MiB that it may take, half of what is free: make it"),
                         DataError);
  } else if (!room || k_bytes < room->bytes / 4) {
    CHECK(sample({claimed(32'000)}, materials, {}).pictures == 0);
  }
  CHECK(sample({claimed(60'000)}, materials, {}).pictures == 0);  // of too many texels for any
}
