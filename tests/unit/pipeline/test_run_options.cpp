// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <optional>
#include <string>
#include <tuple>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/pipeline/run_options.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Octahedra in a row that touch at their tips, and tori pinched to a point: which coincident
/// vertices are merged depends on what a seam cuts through.
Mesh touching_everywhere() {
  constexpr std::uint32_t k_many = 40;
  Mesh mesh;
  for (std::uint32_t i = 0; i < k_many; ++i) {
    Mesh octahedron = test::octahedron();
    Mesh torus = test::torus_with_neck(12, 6);
    for (Vec3& p : octahedron.positions) p.x += 2.0 * i;
    for (Vec3& p : torus.positions) p = p * 0.1 + Vec3{2.0 * i, 3, 0};
    test::append(mesh, octahedron);
    test::append(mesh, torus);
  }
  return mesh;
}

/// What a summary tells of the input, and the count that a ratio asks for.
using Told = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;

Told told_of(const Manifest& m) {
  return {m.input_triangles, m.coincident_vertices, m.coincident_corners,
          target_triangles(m, {.ratio = 0.1})};
}

}  // namespace

TEST_CASE("one input is told and aimed at alike, however it is divided and in whatever order") {
  const test::TempFolder folder;
  Mesh mesh = touching_everywhere();
  std::optional<Told> told;
  for (const std::uint64_t seed : {0, 1, 2}) {
    if (seed != 0) shuffle(mesh, seed);
    for (const std::uint32_t parts : {1U, 3U, 16U}) {
      CAPTURE(seed);
      CAPTURE(parts);
      const std::string name = std::to_string(seed) + "-" + std::to_string(parts);
      test::MemorySource source(mesh);
      const Manifest cut =
          cut_mesh(source, Stage::create(folder / ("cut-" + name)), {.parts = parts});
      const Manifest streams = cut_mesh(source, Stage::create(folder / ("streams-" + name)),
                                        {.scheme = Scheme::stream, .parts = parts});
      if (!told) told = told_of(cut);
      CHECK(told_of(cut) == *told);
      CHECK(told_of(streams) == *told);
    }
  }
  CHECK(std::get<1>(*told) == 39 + 40 * 5);  // tips, and necks of six vertices
  CHECK(std::get<2>(*told) == 40 * 12);
}

TEST_CASE("textures are kept where the number of triangles allows it, else baked") {
  Manifest manifest;
  manifest.input_triangles = 10'000;
  manifest.uvs = true;
  manifest.uv_floor = 1'000;
  manifest.uv_side = 8;
  Material material{.name = "skin"};
  material.maps = {{MapUse::colour, 0}};
  manifest.labels = LabelMeaning{"material", {material}};
  const std::uint64_t floor = texture_floor(manifest);
  CHECK(floor == 1'200);
  const auto made = [&](RunOptions run) { return chosen_textures(manifest, run); };
  CHECK(made({.ratio = 0.12}) == TextureMode::keep);
  CHECK(made({.ratio = 0.1199}) == TextureMode::bake);
  CHECK(made({.error = {0.5, false}}) == TextureMode::keep);
  CHECK(made({.ratio = 0.5, .textures = TextureMode::drop}) == TextureMode::drop);
  CHECK(made({.ratio = 0.5, .channels = parse_choice("none", "")}) == TextureMode::drop);
  CHECK(made({.ratio = 0.5, .channels = parse_choice("uvs", "")}) == TextureMode::keep);

  // A run that keeps textures gets as many triangles as they need.
  const RunOptions keep{.triangles = 50, .textures = TextureMode::keep};
  CHECK(asked_triangles(manifest, keep) == 50);
  CHECK(target_triangles(manifest, keep) == floor);
  CHECK(lines_of(manifest, keep).columns == ColumnSet{true, true});
  CHECK(lines_of(manifest, keep).uv_scale == doctest::Approx(0.8));
  // A picture has the colours of all materials.
  const RunOptions bake{.triangles = 50, .textures = TextureMode::bake};
  CHECK(target_triangles(manifest, bake) == 50);
  CHECK(lines_of(manifest, bake).columns == ColumnSet{false, false});
  CHECK(run_key(manifest, bake) != run_key(manifest, keep));
  RunOptions large = bake;
  large.texture_size = 512;
  CHECK(run_key(manifest, large) != run_key(manifest, bake));

  manifest.uvs = false;
  CHECK(made({.ratio = 0.5}) == TextureMode::drop);
}

TEST_CASE("where there are no pictures of colours, no new one is made") {
  Manifest manifest;
  manifest.input_triangles = 10'000;
  manifest.uvs = true;
  manifest.uv_floor = 1'000;
  const auto made = [&](RunOptions run) { return chosen_textures(manifest, run); };
  const auto check_none = [&] {
    CHECK(made({.ratio = 0.5}) == TextureMode::keep);
    CHECK(made({.ratio = 0.01}) == TextureMode::drop);
    CHECK(made({.ratio = 0.5, .textures = TextureMode::bake}) == TextureMode::drop);
  };
  check_none();
  manifest.labels = LabelMeaning{"material_index", {}};
  check_none();
  CHECK(chosen_labels(manifest, {.ratio = 0.01}));
  Material material{.name = "skin"};
  material.maps = {{MapUse::normal, 0}};
  manifest.labels = LabelMeaning{"material", {material}};
  check_none();
}
