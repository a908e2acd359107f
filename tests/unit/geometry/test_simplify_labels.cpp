// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/label_corners.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/simplify/simplify_lines.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

Vec3 centre_of(const Mesh& mesh, const Triangle& t) {
  return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3);
}

template <typename LabelAt>
Mesh labelled(Mesh mesh, const LabelAt& label_at) {
  for (const Triangle& t : mesh.triangles)
    mesh.columns.labels.push_back(label_at(centre_of(mesh, t)));
  return mesh;
}

Label octant(Vec3 p) {
  return (p.x > 0 ? 1U : 0U) + (p.y > 0 ? 2U : 0U) + (p.z > 0 ? 4U : 0U);
}

Mesh simplified_labelled(const Mesh& mesh, std::uint64_t triangles,
                         TopologyMode topology = TopologyMode::automatic) {
  SimplifyOptions options;
  options.lines.topology = topology;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({.triangles = triangles});
  return simplifier.mesh();
}

using Line = std::pair<Vec3, Vec3>;

/// The edges between triangles of two labels.
std::vector<Line> lines_of(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<Label>> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      edges[std::minmax(t[k], t[(k + 1) % 3])].insert(mesh.columns.labels[i]);
    }
  }
  std::vector<Line> lines;
  for (const auto& [edge, labels] : edges) {
    if (labels.size() < 2) continue;
    lines.emplace_back(mesh.positions[edge.first], mesh.positions[edge.second]);
  }
  return lines;
}

double length_of(const std::vector<Line>& lines) {
  double sum = 0;
  for (const auto& [a, b] : lines) sum += length(b - a);
  return sum;
}

std::map<Label, double> areas_of(const Mesh& mesh) {
  std::map<Label, double> areas;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    const Vec3 at = mesh.positions[a];
    areas[mesh.columns.labels[i]] +=
        length(cross(mesh.positions[b] - at, mesh.positions[c] - at)) / 2;
  }
  return areas;
}

const std::vector<TopologyMode> k_label_modes = {TopologyMode::automatic, TopologyMode::keep,
                                                 TopologyMode::simplify};

}  // namespace

TEST_CASE("lines between labels stay where they are") {
  const Mesh ball = labelled(sphere(5), octant);
  REQUIRE(ball.triangles.size() == 8192);
  for (const TopologyMode mode : k_label_modes) {
    for (const std::uint64_t target : {2000, 400, 120}) {
      CAPTURE(target);
      const Mesh result = simplified_labelled(ball, target, mode);
      CHECK(result.triangles.size() <= target);
      CHECK(result.triangles.size() + 2 > target);
      REQUIRE(result.columns.labels.size() == result.triangles.size());
      CHECK(is_clean(result));
      for (std::size_t i = 0; i < result.triangles.size(); ++i) {
        CHECK(octant(centre_of(result, result.triangles[i])) == result.columns.labels[i]);
      }
      // Three great circles, with chords instead of arcs.
      CHECK(length_of(lines_of(result)) == doctest::Approx(6 * std::numbers::pi).epsilon(0.05));
      for (const auto& [a, b] : lines_of(result)) {
        const Vec3 m = (a + b) * 0.5;
        CHECK(std::min({std::abs(m.x), std::abs(m.y), std::abs(m.z)}) < 0.002);
      }
    }
  }
}

TEST_CASE("a jagged region keeps its area and its place") {
  const auto is_inside = [](Vec3 p) -> Label { return std::hypot(p.x - 0.5, p.y - 0.5) < 0.3; };
  const Mesh flat = labelled(wavy_grid(100, 100), is_inside);
  const double before = areas_of(flat).at(1);
  for (const TopologyMode mode : k_label_modes) {
    const Mesh result = simplified_labelled(flat, 400, mode);
    CHECK(result.triangles.size() <= 400);
    CHECK(areas_of(result).at(1) == doctest::Approx(before).epsilon(0.02));
    for (const auto& [a, b] : lines_of(result)) {
      for (const Vec3 p : {a, b}) CHECK(std::abs(std::hypot(p.x - 0.5, p.y - 0.5) - 0.3) < 0.03);
    }
  }
}

TEST_CASE("a round region neither grows nor shrinks as its line becomes coarse") {
  Mesh flat = wavy_grid(100, 100);
  for (Vec3& p : flat.positions) p.z = 0;
  const auto is_inside = [](Vec3 p) -> Label { return std::hypot(p.x - 0.5, p.y - 0.5) < 0.3; };
  flat = labelled(std::move(flat), is_inside);
  const double before = areas_of(flat).at(1);
  for (const std::uint64_t target : {100, 40, 24}) {
    CAPTURE(target);
    const Mesh result = simplified_labelled(flat, target);
    CHECK(areas_of(result).at(1) == doctest::Approx(before).epsilon(0.0035));
  }
}

/// The mean square of how far the triangles of a sphere of radius 1 lie inside it.
double sag_of(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const double sag = 1 - length(centre_of(mesh, t));
    sum += sag * sag;
  }
  return std::sqrt(sum / static_cast<double>(mesh.triangles.size()));
}

TEST_CASE("labels as fine as the result leave vertices for the surface") {
  const Mesh ball = sphere(6);
  const auto waves = [](Vec3 p) -> Label {
    return std::sin(30 * p.x) + std::sin(30 * p.y) + std::sin(30 * p.z) > 0 ? 1 : 0;
  };
  const Mesh result = simplified_labelled(labelled(ball, waves), 3000);
  const Mesh plain = simplified_labelled(ball, 3000);
  CHECK(result.triangles.size() == plain.triangles.size());
  CHECK(lines_of(result).size() > 300);
  CHECK(sag_of(result) < 2 * sag_of(plain));
}

TEST_CASE("lines between labels count less where they have more than half of the vertices") {
  CHECK(label_line_weight(0, 0) == 7);
  CHECK(label_line_weight(50, 100) == 7);
  CHECK(label_line_weight(52, 100) == 3.5);
  CHECK(label_line_weight(60, 100) == 7.0 / 32);
  CHECK(label_line_weight(100, 100) > 0);
}

TEST_CASE("labels that are all the same change nothing") {
  const Mesh mesh = wavy_grid(60, 60);
  const Mesh plain = simplified_labelled(mesh, 500);
  const Mesh result = simplified_labelled(labelled(mesh, [](Vec3) { return 7U; }), 500);
  CHECK(result.positions == plain.positions);
  CHECK(result.triangles == plain.triangles);
  CHECK(result.columns.labels == std::vector<Label>(plain.triangles.size(), 7));
}

TEST_CASE("labels go with their triangles where these are dropped") {
  Mesh mesh = labelled(wide_torus(40, 20), [](Vec3 p) { return p.z > 0 ? 1U : 0U; });
  const double before = areas_of(mesh).at(1);
  // A degenerate triangle in front, a duplicate, and a piece that is dropped further down.
  mesh.triangles.insert(mesh.triangles.begin(), {{0, 0, 1}, mesh.triangles[5]});
  mesh.columns.labels.insert(mesh.columns.labels.begin(), {9, mesh.columns.labels[5]});
  const Mesh result = simplified_labelled(mesh, 1500);
  REQUIRE(result.columns.labels.size() == result.triangles.size());
  CHECK(areas_of(result).size() == 2);
  CHECK(areas_of(result).at(1) == doctest::Approx(before).epsilon(0.01));
}

TEST_CASE("corners are where labels hold a vertex") {
  const auto corners_of = [](const Mesh& mesh) {
    return count_label_corners(mesh.triangles, mesh.columns.labels, mesh.positions.size());
  };
  CHECK(corners_of(sphere(3)) == 0);
  const Mesh ball = labelled(sphere(3), octant);
  CHECK(corners_of(ball) == 6);
  CHECK(corners_of(labelled(sphere(3), [](Vec3 p) -> Label { return p.z > 0 ? 7 : 3; })) == 0);
  Mesh fine = sphere(3);
  for (Label i = 0; i < fine.triangles.size(); ++i) fine.columns.labels.push_back(i);
  CHECK(corners_of(fine) == fine.positions.size());
}

TEST_CASE("labels must be one a triangle") {
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {1, 2};
  CHECK_THROWS_AS(Simplifier(mesh, {}), UsageError);
}
