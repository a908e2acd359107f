// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/pipeline/sink_need.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

Manifest manifest_with(std::uint64_t triangles) {
  Manifest manifest;
  manifest.input_triangles = triangles;
  manifest.parts = {{{}, triangles / 2, triangles - 1000, 100}};
  manifest.boundary_triangles = 1000;
  return manifest;
}

}  // namespace

TEST_CASE("the sink needs about what was measured") {
  const Manifest manifest = manifest_with(10'000'000);
  const auto half = sink_need(manifest, {.ratio = 0.5});
  REQUIRE(half);
  CHECK(half->triangles > 6'000'000);
  CHECK(half->triangles < 8'000'000);
  const auto few = sink_need(manifest, {.ratio = 0.02});
  CHECK(few->triangles > 400'000);
  CHECK(few->triangles < 700'000);
  CHECK(few->bytes < std::uint64_t{200} << 20);
  CHECK_FALSE(sink_need(manifest, {.error = {0.1, true}}));
}

TEST_CASE("the sink needs more for a large picture that it puts together") {
  Manifest manifest = manifest_with(1'000'000);
  manifest.uvs = true;
  Material skin{.name = "skin"};
  skin.maps = {{MapUse::colour, 0}};
  manifest.labels = LabelMeaning{"material", {skin}};
  const auto bytes = [&](TextureMode textures, std::uint32_t side) {
    return sink_need(manifest, {.ratio = 0.01, .textures = textures, .texture_size = side})->bytes;
  };
  CHECK(bytes(TextureMode::bake, 8192) > std::uint64_t{16} * 8192 * 8192);
  CHECK(bytes(TextureMode::bake, 0) > std::uint64_t{16} * 4096 * 4096);
  CHECK(bytes(TextureMode::bake, 0) > bytes(TextureMode::keep, 0));
}

TEST_CASE("what a sink can never hold is refused, what does not fit here is told") {
  const Manifest manifest = manifest_with(4'000'000'000);
  const auto here = [](double ratio) {
    return RunOptions{.ratio = ratio, .finish_place = FinishPlace::here};
  };
  CHECK_THROWS_WITH_AS(check_sink_need(manifest, here(0.5), std::nullopt),
                       "a result of 2000 million triangles is too large: the sink holds at most "
                       "1431 million; ask for fewer",
                       UsageError);
  CHECK(check_sink_need(manifest, here(0.3), std::nullopt).find("may fail at the end") !=
        std::string::npos);
  CHECK(check_sink_need(manifest, here(0.01), std::nullopt).empty());
  CHECK(check_sink_need(manifest, here(0.01), std::uint64_t{64} << 30).empty());
  CHECK(check_sink_need(manifest, here(0.01), std::uint64_t{4} << 30).find("4096 MiB are free") !=
        std::string::npos);
  CHECK(check_sink_need(manifest, {.error = {0.1, true}}, 1).empty());
  CHECK(check_sink_need(manifest, {.ratio = 0.5}, 1).empty());  // no process holds it
  CHECK(check_sink_need(manifest, {.ratio = 0.001}, 1).find("are free") != std::string::npos);
}
