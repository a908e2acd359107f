// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include <meshfarm/geometry/surface_sampler.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

SurfaceSamples sampled(const Mesh& mesh, std::uint64_t samples, std::size_t piece) {
  SurfaceSampler sampler(samples);
  for (std::size_t first = 0; first < mesh.triangles.size(); first += piece) {
    sampler.add(
        mesh.positions,
        std::span(mesh.triangles).subspan(first, std::min(piece, mesh.triangles.size() - first)));
  }
  return sampler.take();
}

}  // namespace

TEST_CASE("samples are shared out by area, whatever the size of triangles and their order") {
  Mesh mesh = test::grid(100, 100);  // 20,000 small triangles, then two large ones
  mesh.positions.insert(mesh.positions.end(),
                        {{200, 0, 0}, {500, 0, 0}, {500, 100, 0}, {200, 100, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{10'201, 10'202, 10'203}, {10'201, 10'203, 10'204}});
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (const std::size_t piece : {1, 100, 30'000}) {
      CAPTURE(piece);
      const SurfaceSamples samples = sampled(mesh, 1000, piece);
      CHECK(samples.area == doctest::Approx(40'000));
      CHECK(samples.points.size() >= 667);
      CHECK(samples.points.size() <= 1334);
      const auto left = std::count_if(samples.points.begin(), samples.points.end(),
                                      [](Vec3 p) { return p.x <= 100; });
      CHECK(static_cast<double>(left) / static_cast<double>(samples.points.size()) ==
            doctest::Approx(0.25).epsilon(0.02));
      const auto low = std::count_if(samples.points.begin(), samples.points.end(),
                                     [](Vec3 p) { return p.y <= 50; });
      CHECK(static_cast<double>(low) / static_cast<double>(samples.points.size()) ==
            doctest::Approx(0.5).epsilon(0.1));
    }
  }
}

TEST_CASE("no samples of nothing, and none if none are asked for") {
  CHECK(sampled(test::grid(3, 3), 0, 5).points.empty());
  Mesh flat = test::grid(3, 3);
  for (Vec3& p : flat.positions) p.y = 0;
  CHECK(sampled(flat, 10, 5).points.empty());
}
