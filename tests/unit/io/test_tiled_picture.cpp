// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/tiled_levels.hpp"
#include "picture_files.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A different level in each texel.
Picture speckled(std::uint32_t width, std::uint32_t height) {
  return picture_of(width, height, [](std::uint32_t x, std::uint32_t y) {
    return Texel{static_cast<std::uint8_t>(x * 7 + y), static_cast<std::uint8_t>(x ^ y),
                 static_cast<std::uint8_t>(x * y)};
  });
}

class Bench {
 public:
  Bench() : stage_(Stage::create(folder_.path())) {}
  const Stage& stage() const { return stage_; }
  TiledPicturesRef write(const std::vector<std::pair<std::uint32_t, std::string>>& pictures) {
    std::string bytes;
    TiledPicturesWriter writer([&](std::string_view more) { bytes += more; });
    for (const auto& [number, file] : pictures) writer.add(number, file);
    const FileSection directory = writer.finish();
    return {stage_.publish(ResultName{1, ++files_, 1}, bytes), directory};
  }

 private:
  TempFolder folder_;
  Stage stage_;
  std::uint32_t files_ = 0;
};

}  // namespace

TEST_CASE("tiles have the texels of the picture and its smaller copies") {
  Bench bench;
  const Picture picture = speckled(300, 131);
  const TiledPicturesRef ref = bench.write({{3, png_of(gradient(5))}, {8, png_of(picture)}});
  const auto opened = open_tiled_pictures(bench.stage(), ref, std::make_shared<TileCache>(50'000));
  REQUIRE(opened.size() == 2);
  CHECK(opened[0]->number() == 3);
  CHECK(opened[1]->number() == 8);
  const DecodedLevels whole(picture);
  const PictureLevels& tiled = *opened[1];
  REQUIRE(tiled.sizes().size() == whole.sizes().size());
  for (std::size_t level = 0; level < whole.sizes().size(); ++level) {
    const auto [width, height] = whole.sizes()[level];
    REQUIRE(tiled.sizes()[level].width == width);
    bool is_same = true;
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const std::uint32_t right = (x + 1) % width, below = (y + 1) % height;
        is_same = is_same && tiled.texels(level, x, y, right, below) ==
                                 whole.texels(level, x, y, right, below);
      }
    }
    CHECK(is_same);
  }
}

TEST_CASE("materials look the same by tiles as by whole pictures") {
  Bench bench;
  const std::string files[] = {png_of(speckled(200, 200)), png_of(gradient(40))};
  const TiledPicturesRef ref = bench.write({{0, files[0]}, {1, files[1]}});
  LabelMeaning labels{"material", {{.name = "a"}, {.name = "b"}}};
  labels.materials[0].maps = {{MapUse::colour, 0}};
  labels.materials[1].maps = {{MapUse::colour, 1}};
  labels.materials[1].wrap_u = TextureWrap::mirror;
  const MaterialColours whole(labels, {{"a.png", "b.png"}, [&](std::size_t i) { return files[i]; }},
                              {.name = "mesh"});
  const MaterialColours tiled(labels, bench.stage(), std::span(&ref, 1), 1 << 20);
  for (int i = 0; i < 500; ++i) {
    const Uv uv{static_cast<float>(i * 37 % 100) / 45 - 1, static_cast<float>(i) / 400};
    for (const Label label : {0U, 1U}) {
      CHECK(whole.at(label, uv, 1 + i % 9) == tiled.at(label, uv, 1 + i % 9));
      CHECK(whole.texels_of(label, {uv, {0, 0}, {1, 0}}) ==
            tiled.texels_of(label, {uv, {0, 0}, {1, 0}}));
    }
  }
}

TEST_CASE("a material whose picture is in no file has its colour") {
  Bench bench;
  LabelMeaning labels{"material", {{.name = "a", .colour = {0.5F, 0.25F, 1, 1}}}};
  labels.materials[0].maps = {{MapUse::colour, 4}};
  const TiledPicturesRef ref = bench.write({{0, png_of(gradient(4))}});
  const MaterialColours colours(labels, bench.stage(), std::span(&ref, 1), 1 << 20);
  CHECK(colours.at(0, {0.5F, 0.5F}, 1) == std::array<float, 3>{0.5F, 0.25F, 1});
}

TEST_CASE("a damaged picture leaves no trace among the tiles") {
  Bench bench;
  std::string bytes;
  TiledPicturesWriter writer([&](std::string_view more) { bytes += more; });
  std::string cut = png_of(speckled(90, 90));
  cut.resize(cut.size() / 2);
  CHECK_THROWS_AS(writer.add(0, cut), DataError);
  CHECK_THROWS_AS(writer.add(1, "no picture"), DataError);
  CHECK(bytes.empty());
  writer.add(2, png_of(gradient(9)));
  const FileSection directory = writer.finish();
  const FileRef file = bench.stage().publish(ResultName{9, 1, 1}, bytes);
  const auto opened =
      open_tiled_pictures(bench.stage(), {file, directory}, std::make_shared<TileCache>(1));
  REQUIRE(opened.size() == 1);
  CHECK(opened[0]->number() == 2);
}

TEST_CASE("a cache keeps what was used last, and one tile at least") {
  TileCache cache(10);
  int reads = 0;
  const auto tile = [&](std::uint64_t number, std::size_t size) {
    return cache.tile(number, [&] {
      ++reads;
      return std::string(size, 'x');
    });
  };
  tile(1, 4);
  tile(2, 4);
  tile(1, 4);
  CHECK(reads == 2);
  tile(3, 4);  // evicts 2
  tile(1, 4);
  CHECK(reads == 3);
  tile(2, 4);
  CHECK(reads == 4);
  CHECK(tile(4, 100)->size() == 100);
  tile(4, 100);
  CHECK(reads == 5);
}

TEST_CASE("what a picture says of itself") {
  const PictureFacts png = picture_facts(png_of(gradient(30)));
  CHECK(png.width == 30);
  CHECK(png.height == 30);
  CHECK_FALSE(png.is_lossy);
  CHECK(png.decoding_bytes >= 4 * 30 * 30);
  CHECK_THROWS_AS(picture_facts("none"), DataError);
}
