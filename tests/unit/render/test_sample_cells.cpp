// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "render/sample_cells.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Camera camera_of(const Mesh& mesh, const View& view, double width) {
  Framing framing(view, {0, 0, width, 0.75 * width});
  framing.add(mesh.positions);
  return framing.camera();
}

/// By the exact projection: a triangle between two neighbouring columns or rows of sample centres
/// covers no sample.
bool covers_none(const Camera& camera, const Mesh& mesh, const Triangle& t) {
  const ScreenPoint a = camera.project(mesh.positions[t[0]]);
  const ScreenPoint b = camera.project(mesh.positions[t[1]]);
  const ScreenPoint c = camera.project(mesh.positions[t[2]]);
  const auto between = [](float x, float y, float z) {
    const float below = std::floor(std::min({x, y, z}));
    return below < std::min({x, y, z}) && std::max({x, y, z}) < below + 1;
  };
  return between(a.x, b.x, c.x) || between(a.y, b.y, c.y);
}

/// may_cover() compared with the exact projection, counted over triangles and pictures.
struct Told {
  std::uint64_t wrong = 0;    // may cover a sample, but is said not to
  std::uint64_t in_vain = 0;  // covers no sample, but is said to
  std::uint64_t none = 0;
};

Told looked_at(const Mesh& mesh, const std::vector<Camera>& cameras) {
  std::vector<const Camera*> all;
  for (const Camera& each : cameras) all.push_back(&each);
  const SampleCells cells(all, mesh.positions);
  Told told;
  for (const Triangle& t : mesh.triangles) {
    const unsigned may_cover = cells.may_cover(t);
    CHECK((may_cover >> cameras.size()) == 0);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const bool none = covers_none(cameras[i], mesh, t);
      const bool may = (may_cover >> i & 1U) != 0;
      if (!none && !may) ++told.wrong;
      if (none && may) ++told.in_vain;
      if (none) ++told.none;
    }
  }
  return told;
}

}  // namespace

TEST_CASE("triangles are left out only where they cover no sample, and nearly all that don't are") {
  const Mesh sphere = test::icosphere(6);
  const View flat{.projection = Projection::orthographic, .azimuth = 200, .elevation = -20};
  for (const Vec3 offset : {Vec3{}, Vec3{4e6, -7e6, 3e3}}) {
    CAPTURE(offset.x);
    Mesh mesh = sphere;
    for (Vec3& p : mesh.positions) p = p + offset;
    const Told told = looked_at(mesh, {camera_of(mesh, {.azimuth = 25, .elevation = 18}, 90),
                                       camera_of(mesh, flat, 120), camera_of(mesh, {}, 60)});
    CHECK(told.wrong == 0);
    CHECK(told.none > 40'000);
    CHECK(told.in_vain * 50 < told.none);
  }
}

TEST_CASE("what is not a number, behind the viewer or off the picture is in doubt") {
  Mesh mesh = test::icosphere(4);
  const std::vector<Camera> cameras = {camera_of(mesh, {}, 40), camera_of(mesh, {}, 41),
                                       camera_of(mesh, {}, 42), camera_of(mesh, {}, 43)};
  mesh.positions[0].x = std::nan("");
  mesh.positions[7].y = std::numeric_limits<double>::infinity();
  mesh.positions[20] = mesh.positions[20] * 1e9;
  mesh.positions[30] = mesh.positions[30] * -40;
  mesh.positions[33] = {100, 100, 100};
  CHECK(looked_at(mesh, cameras).wrong == 0);
}
