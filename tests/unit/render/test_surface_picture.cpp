// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/render/surface_picture.hpp>

#include "render/colours.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

RenderOptions small(ColourBy by) {
  RenderOptions options;
  options.width = 160;
  options.height = 120;
  options.colour_by = by;
  options.threads = 1;
  return options;
}

Camera camera_for(const RenderOptions& options, const Mesh& mesh) {
  Framing framing(options.view, SurfacePicture::frame_of(options));
  framing.add(mesh.positions);
  return framing.camera();
}

Mesh some_mesh() {
  return test::torus(60, 200);  // with triangles as small as samples, and smaller
}

}  // namespace

TEST_CASE("a surface in pieces, in any order, makes the picture of the whole mesh") {
  const Mesh mesh = some_mesh();
  for (const ColourBy by : {ColourBy::none, ColourBy::normal}) {
    RenderOptions options = small(by);
    options.wire = by == ColourBy::none;
    test::MemorySource source(mesh);
    const Texels whole = render_mesh(source, options).picture;
    SurfacePicture picture(options, camera_for(options, mesh));
    const std::span<const Triangle> all(mesh.triangles);
    picture.draw(mesh.positions, all.subspan(20));
    picture.draw(mesh.positions, all.first(20));
    CHECK(picture.finish().bytes == whole.bytes);
  }
}

TEST_CASE("parts have colours of their own, and what is between them another") {
  const Mesh mesh = some_mesh();
  const RenderOptions options = small(ColourBy::part);
  const auto drawn = [&](std::uint32_t part) {
    SurfacePicture picture(options, camera_for(options, mesh));
    picture.draw(mesh.positions, mesh.triangles, {.part = part});
    return picture.finish().bytes;
  };
  CHECK(drawn(0) != drawn(1));
  CHECK(drawn(1) == drawn(1));
  CHECK(drawn(PiecePaint::k_between) != drawn(0));
}

TEST_CASE("values are on the scale of the range") {
  const Mesh mesh = some_mesh();
  RenderOptions options = small(ColourBy::quality);
  options.range = {0.0, 2.0};
  const auto drawn = [&](float value) {
    const std::vector<float> values(mesh.positions.size(), value);
    SurfacePicture picture(options, camera_for(options, mesh));
    picture.draw(mesh.positions, mesh.triangles, {.values = values});
    return picture.finish().bytes;
  };
  CHECK(drawn(0) != drawn(1));
  CHECK(drawn(2) == drawn(3));
}

TEST_CASE("another look is the same picture in other colours") {
  const Mesh mesh = some_mesh();
  const RenderOptions options = small(ColourBy::none);
  const auto alone = [&](ColourBy by) {
    SurfacePicture picture(small(by), camera_for(options, mesh));
    picture.draw(mesh.positions, mesh.triangles, {.part = 3});
    return picture.finish().bytes;
  };
  SurfacePicture both(options, camera_for(options, mesh));
  const std::size_t by_part = both.add_look(ColourBy::part);
  both.draw(mesh.positions, mesh.triangles, {.part = 3});
  CHECK(both.finish().bytes == alone(ColourBy::none));
  CHECK(both.finish(by_part).bytes == alone(ColourBy::part));
}
