// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertex_fit.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// A grid with wavy heights.
Mesh waves(std::uint32_t cells) {
  Mesh mesh = test::grid(cells, cells);
  for (Vec3& p : mesh.positions) {
    p = {p.x / cells, p.y / cells, 0.1 * std::sin(9 * p.x / cells) * std::cos(7 * p.y / cells)};
  }
  return mesh;
}

std::vector<SurfaceSamples> samples_of(const Mesh& mesh, std::uint64_t count) {
  return {sample_surface(mesh, {.samples = count, .threads = 1})};
}

double rms_between(const Mesh& a, const Mesh& b) {
  const DistanceOptions options{.samples = 50'000, .threads = 1};
  return std::max(measure_distance(a, b, options).rms, measure_distance(b, a, options).rms);
}

Mesh simplified(Mesh mesh, std::uint64_t triangles) {
  Simplifier simplifier(std::move(mesh), {});
  simplifier.reduce({.triangles = triangles});
  return simplifier.mesh();
}

bool is_at_border(Vec3 p) {
  return p.x == 0 || p.y == 0 || p.x == 1 || p.y == 1;
}

}  // namespace

TEST_CASE("fitted vertices bring a simplified surface nearer to the input, in both directions") {
  for (const Mesh& input : {waves(120), test::icosphere(5)}) {
    const Mesh before = simplified(input, 600);
    Mesh after = before;
    CHECK(fit_vertices(after, samples_of(input, 12'000), {.threads = 1}) > 200);
    CHECK(after.triangles == before.triangles);
    CHECK(rms_between(after, input) < 0.975 * rms_between(before, input));
  }
}

TEST_CASE("a vertex that was pushed off its surface comes most of the way back") {
  const Mesh input = waves(40);
  Mesh pushed = input;
  const std::size_t v = 20 * 41 + 20;
  pushed.positions[v].z += 0.01;
  fit_vertices(pushed, samples_of(input, 200'000), {.threads = 1});
  CHECK(length(pushed.positions[v] - input.positions[v]) < 0.004);
}

TEST_CASE("what is fitted already stays: flat surfaces, and the input itself") {
  Mesh coarse = test::grid(5, 5);
  for (Vec3& p : coarse.positions) p = p * 4 + Vec3{100, 30, 7};
  Mesh fine = test::grid(20, 20);
  for (Vec3& p : fine.positions) p = p + Vec3{100, 30, 7};
  for (const auto& [mesh, input] : {std::pair(coarse, fine), std::pair(waves(20), waves(20))}) {
    Mesh fitted = mesh;
    CHECK(fit_vertices(fitted, samples_of(input, 10'000), {.threads = 1}) == 0);
    CHECK(fitted.positions == mesh.positions);
  }
}

TEST_CASE("locked vertices, borders and creases stay where that is asked for") {
  const Mesh input = waves(120);
  const Mesh before = simplified(input, 600);
  Mesh after = before;
  fit_vertices(after, samples_of(input, 12'000), {.keeps_borders = true, .threads = 1});
  bool border_stays = true;
  for (std::size_t v = 0; v < after.positions.size(); ++v) {
    if (!is_at_border(before.positions[v])) continue;
    border_stays = border_stays && after.positions[v] == before.positions[v];
  }
  CHECK(border_stays);

  after = before;
  const std::uint32_t locked = 50;
  CHECK(fit_vertices(after, samples_of(input, 12'000), {.locked_vertices = locked, .threads = 1}) >
        100);
  for (std::size_t v = 0; v < locked; ++v) CHECK(after.positions[v] == before.positions[v]);

  // A roof: its ridge is a crease, and the surface it stands for is higher.
  Mesh roof = test::grid(10, 10);
  for (Vec3& p : roof.positions) p.z = 5 - std::abs(p.x - 5);
  Mesh higher = roof;
  for (Vec3& p : higher.positions) p.z += 0.05;
  Mesh moved = roof;
  fit_vertices(moved, samples_of(higher, 10'000), {.crease_angle = 40, .threads = 1});
  Mesh free = roof;
  fit_vertices(free, samples_of(higher, 10'000), {.threads = 1});
  for (std::size_t v = 0; v < roof.positions.size(); ++v) {
    if (roof.positions[v].x != 5) continue;
    CHECK(moved.positions[v] == roof.positions[v]);
    CHECK(free.positions[v].z > roof.positions[v].z + 0.02);
  }
}

TEST_CASE("where lines between labels meet or end their vertex stays, along them it moves") {
  Mesh mesh = waves(10);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
    mesh.columns.labels.push_back(middle.x < 0.5 ? 0 : middle.y < 0.5 ? 1 : 2);
  }
  Mesh higher = waves(60);
  for (Vec3& p : higher.positions) p.z += 0.02;
  const Mesh before = mesh;
  fit_vertices(mesh, samples_of(higher, 20'000), {.threads = 1});
  int corners = 0;
  int others = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = before.positions[v];
    const bool on_first = p.x == 0.5;
    const bool on_second = p.y == 0.5 && p.x > 0.5;
    if (!on_first && !on_second) continue;
    const bool is_corner = is_at_border(p) || (on_first && p.y == 0.5);
    CHECK((mesh.positions[v] == p) == is_corner);
    ++(is_corner ? corners : others);
  }
  CHECK(corners == 4);
  CHECK(others == 12);
}

TEST_CASE("triangles of no area and any size or place of the mesh do no harm") {
  const Mesh input = waves(60);
  const Mesh coarse = simplified(input, 300);
  Mesh fitted = coarse;
  fit_vertices(fitted, samples_of(input, 6'000), {.threads = 1});
  for (const double scale : {0x1p-30, 0x1p30}) {
    Mesh scaled = coarse;
    for (Vec3& p : scaled.positions) p = p * scale;
    Mesh scaled_input = input;
    for (Vec3& p : scaled_input.positions) p = p * scale;
    // As left by a flap that was folded up, and by a needle between two vertices.
    scaled.triangles.push_back({0, 1, 1});
    scaled.triangles.push_back({2, 3, 2});
    CHECK(fit_vertices(scaled, samples_of(scaled_input, 6'000), {.threads = 1}) > 50);
    double farthest = 0;
    for (std::size_t v = 0; v < scaled.positions.size(); ++v) {
      farthest =
          std::max(farthest, length(scaled.positions[v] * (1 / scale) - fitted.positions[v]));
    }
    CHECK(farthest < 1e-6);
  }
}

TEST_CASE("vertices at one place stay together") {
  // Two sheets that touch at a corner, where each would go its own way.
  Mesh mesh = waves(10);
  const Mesh other = waves(10);
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back({-p.x, -p.y, p.z});
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({a + count, b + count, c + count});
  }
  Mesh higher = mesh;
  for (Vec3& p : higher.positions) p.z += p.x > 0 ? 0.01 : -0.01;
  REQUIRE(mesh.positions[0] == mesh.positions[count]);
  fit_vertices(mesh, samples_of(higher, 20'000), {.threads = 1});
  CHECK(mesh.positions[0] == other.positions[0]);
  CHECK(mesh.positions[count] == other.positions[0]);
  CHECK(mesh.positions[12] != other.positions[12]);
}

TEST_CASE("what is far from the surface, as what has gone is, pulls at nothing") {
  const Mesh before = waves(30);
  Mesh far = waves(30);
  for (Vec3& p : far.positions) p.z += 0.5;
  Mesh after = before;
  CHECK(fit_vertices(after, samples_of(far, 10'000), {.threads = 1}) == 0);
  CHECK(after.positions == before.positions);
  CHECK(fit_vertices(after, {}, {.threads = 1}) == 0);
  Mesh none;
  CHECK(fit_vertices(none, samples_of(far, 100), {.threads = 1}) == 0);
}

TEST_CASE("no triangle turns over however the points lie") {
  const Mesh before = waves(12);
  Mesh rough = waves(60);
  for (std::size_t v = 0; v < rough.positions.size(); ++v) {
    rough.positions[v].z += 0.05 * std::sin(static_cast<double>(v * v));
  }
  Mesh after = before;
  CHECK(fit_vertices(after, samples_of(rough, 300), {.threads = 1}) > 0);
  for (const Triangle& t : before.triangles) {
    const auto normal = [&t](const Mesh& m) {
      const Vec3 first = m.positions[t[0]];
      return cross(m.positions[t[1]] - first, m.positions[t[2]] - first);
    };
    const Vec3 was = normal(before);
    const Vec3 is = normal(after);
    CHECK(dot(was, is) > 0.8 * length(was) * length(is));
    CHECK(length(is) > 0.29 * length(was));
  }
}

TEST_CASE("the fit depends on no threads, and keeps floats") {
  const Mesh input = waves(120);
  Mesh one = simplified(input, 600);
  for (Vec3& p : one.positions) p = rounded(p, PositionType::float32);
  Mesh four = one;
  const auto points = samples_of(input, 12'000);
  fit_vertices(one, points, {.positions = PositionType::float32, .threads = 1});
  fit_vertices(four, points, {.positions = PositionType::float32, .threads = 4});
  CHECK(one.positions == four.positions);
  for (const Vec3& p : one.positions) CHECK(p == rounded(p, PositionType::float32));
}
