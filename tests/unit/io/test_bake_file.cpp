// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"

using namespace meshfarm;
using test::check_refuses_damage;

namespace {

BakeScene some_scene() {
  BakeScene scene{512, 4, 0.25, 1.5, {}, {}, {}};
  scene.parts = {{{{0, 1, 2}, {3, 4, 5}}, {"parts/000001.part", 7, 8}, 3}, {{}, {"x", 1, 2}, 0}};
  scene.seams = {{{{-1, -1, -1}, {1, 1, 1}}, {10, 20, 30}}};
  scene.chunks = {{1, 2, 3}, {4, 5, 6}};
  return scene;
}

BakeSurface some_surface() {
  BakeSurface surface;
  surface.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};
  surface.normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}};
  surface.triangles = {{0, 1, 2}};
  surface.uvs = {{{{0, 0}, {1, 0}, {0.5F, 1}}}};
  surface.is_own = {1};
  return surface;
}

}  // namespace

TEST_CASE("a scene is the same after it was written and read") {
  const BakeScene scene = some_scene();
  const BakeScene read = decode_bake_scene(encode_bake_scene(scene), "scene");
  CHECK(read.texture_size == 512);
  CHECK(read.margin_texels == 4);
  CHECK(read.spacing == 0.25);
  CHECK(read.reach == 1.5);
  REQUIRE(read.parts.size() == 2);
  CHECK(read.parts[0].box.hi.y == 4);
  CHECK(read.parts[0].file == scene.parts[0].file);
  CHECK(read.parts[0].boundary_vertices == 3);
  CHECK(read.parts[1].box.empty());
  REQUIRE(read.seams.size() == 1);
  CHECK(read.seams[0].section == scene.seams[0].section);
  CHECK(read.chunks == scene.chunks);
}

TEST_CASE("a chunk and its texels are the same after they were written and read") {
  const BakeSurface surface = some_surface();
  const BakeSurface read = decode_bake_surface(encode_bake_surface(surface), "chunk");
  CHECK(length(read.positions[2] - surface.positions[2]) == 0);
  CHECK(length(read.normals[2] - surface.normals[2]) == 0);
  CHECK(read.triangles == surface.triangles);
  CHECK(read.uvs == surface.uvs);
  CHECK(read.is_own == surface.is_own);
  const BakedTexels texels{{{1, 2, 2}, {5, 3, 1}}, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  const BakedTexels back = decode_baked_texels(encode_baked_texels(texels), "texels");
  CHECK(back.levels == texels.levels);
  REQUIRE(back.runs.size() == 2);
  CHECK(back.runs[1].x == 5);
  CHECK(back.runs[1].count == 1);
}

TEST_CASE("damaged files of a bake are refused") {
  check_refuses_damage(encode_bake_scene(some_scene()),
                       [](std::string_view bytes) { decode_bake_scene(bytes, "scene"); });
  check_refuses_damage(encode_bake_surface(some_surface()),
                       [](std::string_view bytes) { decode_bake_surface(bytes, "chunk"); });
  check_refuses_damage(encode_baked_texels({{{1, 2, 1}}, {{1, 2, 3}}}),
                       [](std::string_view bytes) { decode_baked_texels(bytes, "texels"); });
}

TEST_CASE("what makes no sense in files of a bake is refused") {
  const auto refused = [](const auto& change) {
    BakeScene scene = some_scene();
    change(scene);
    CHECK_THROWS_AS(decode_bake_scene(encode_bake_scene(scene), "scene"), DataError);
  };
  refused([](BakeScene& scene) { scene.texture_size = 1U << 30U; });
  refused([](BakeScene& scene) { scene.margin_texels = 600; });
  refused([](BakeScene& scene) { scene.spacing = -1; });
  refused([](BakeScene& scene) { scene.reach = std::numeric_limits<double>::infinity(); });
  refused([](BakeScene& scene) { scene.parts[0].box.lo.x = std::nan(""); });
  for (const float uv : {-0.5F, 2.0F, std::numeric_limits<float>::quiet_NaN()}) {
    BakeSurface surface = some_surface();
    surface.uvs[0][1][1] = uv;
    CHECK_THROWS_AS(decode_bake_surface(encode_bake_surface(surface), "chunk"), DataError);
  }
  BakeSurface surface = some_surface();
  surface.triangles[0][2] = 3;
  CHECK_THROWS_AS(decode_bake_surface(encode_bake_surface(surface), "chunk"), DataError);
  BakedTexels texels{{{1, 2, 5}}, {{1, 2, 3}}};
  CHECK_THROWS_AS(decode_baked_texels(encode_baked_texels(texels), "texels"), DataError);
}
