// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Sheets with rows of square holes: corners stay as long as anything nearly flat can go, and no
// more holes are closed than is fair.
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// Squares on the integer lattice that share their corners, and the corners of the holes.
class Sheets {
 public:
  /// A square bay of six by six squares, whose middle four may be a hole.
  void add_bay(const std::function<Vec3(int, int)>& at, bool has_hole = true) {
    constexpr int k_squares = 6;
    for (int i = 0; i < k_squares; ++i) {
      for (int k = 0; k < k_squares; ++k) {
        if (has_hole && i / 2 == 1 && k / 2 == 1) continue;
        add_square(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
      }
    }
    if (!has_hole) return;
    for (const auto& [i, k] : {std::pair{2, 2}, {2, 4}, {4, 2}, {4, 4}}) {
      corners_.push_back(number(at(i, k)));
    }
  }

  void add_square(Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
    const std::uint32_t a = number(p);
    const std::uint32_t c = number(r);
    mesh_.triangles.push_back({a, number(q), c});
    mesh_.triangles.push_back({a, c, number(s)});
  }

  const Mesh& mesh() const { return mesh_; }
  Mesh bent(const std::function<Vec3(Vec3)>& bend) const {
    Mesh mesh = mesh_;
    for (Vec3& p : mesh.positions) p = bend(p);
    return mesh;
  }
  const std::vector<std::uint32_t>& corners() const { return corners_; }

 private:
  std::uint32_t number(Vec3 p) {
    const auto [found, is_new] =
        numbers_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) mesh_.positions.push_back(p);
    return found->second;
  }

  Mesh mesh_;
  std::vector<std::uint32_t> corners_;
  std::map<std::tuple<double, double, double>, std::uint32_t> numbers_;
};

/// The number of corners that are not vertices of the result.
std::size_t lost_corners(const Sheets& sheets, const Mesh& mesh, std::uint64_t triangles) {
  Simplifier simplifier(mesh, {});
  simplifier.reduce({triangles});
  CHECK(simplifier.triangles() <= triangles);
  CHECK(static_cast<double>(simplifier.triangles()) >= 0.999 * static_cast<double>(triangles));
  std::size_t lost = 0;
  for (const std::uint32_t corner : sheets.corners()) {
    double nearest = HUGE_VAL;
    for (const Vec3& p : simplifier.mesh().positions) {
      nearest = std::min(nearest, length(p - mesh.positions[corner]));
    }
    lost += nearest > 0.2 ? 1 : 0;
  }
  return lost;
}

/// A plate of bays x bays bays, as thick as a square is wide, with a hole through each bay.
Mesh plate(int bays) {
  Sheets sheets;
  const auto add_walls_round = [&](int x, int y, int size) {
    const auto add = [&](Vec3 from, Vec3 along) {
      const Vec3 up{0, 0, 1};
      sheets.add_square(from, from + along, from + along + up, from + up);
    };
    for (int i = 0; i < size; ++i) {
      for (const int side : {0, size}) {
        add({1.0 * (x + i), 1.0 * (y + side), 0}, {1, 0, 0});
        add({1.0 * (x + side), 1.0 * (y + i), 0}, {0, 1, 0});
      }
    }
  };
  for (int x = 0; x < 6 * bays; x += 6) {
    for (int y = 0; y < 6 * bays; y += 6) {
      for (const double z : {0.0, 1.0}) {
        sheets.add_bay([&](int i, int k) { return Vec3{1.0 * (x + i), 1.0 * (y + k), z}; });
      }
      add_walls_round(x + 2, y + 2, 2);
    }
  }
  add_walls_round(0, 0, 6 * bays);
  return sheets.mesh();
}

/// The greater RMS of both directions.
double error_of(const Mesh& mesh, std::uint64_t triangles, TopologyMode topology) {
  SimplifyOptions options;
  options.lines.topology = topology;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({triangles});
  CHECK(simplifier.triangles() <= triangles);
  CHECK(simplifier.triangles() + 1 >= triangles);
  DistanceOptions samples;
  samples.samples = 50'000;
  samples.threads = 1;
  return std::max(measure_distance(mesh, simplifier.mesh(), samples).rms,
                  measure_distance(simplifier.mesh(), mesh, samples).rms);
}

}  // namespace

TEST_CASE("what is flat between windows in rows goes before their corners") {
  constexpr int k_bays = 20;
  Sheets sheets;
  for (int x = 0; x < 6 * k_bays; x += 6) {
    for (int y = 0; y < 6 * k_bays; y += 6) {
      sheets.add_bay([&](int i, int k) { return Vec3{1.0 * (x + i), 1.0 * (y + k), 0}; });
    }
  }
  const Mesh mesh = sheets.bent([](Vec3 p) {
    return Vec3{p.x, p.y, 6 * (0.004 * p.x * p.x / 36 + 0.02 * std::sin(p.y / 6))};
  });
  // 6.6 triangles per bay; the corners alone need 5.9.
  CHECK(lost_corners(sheets, mesh, 2640) == 0);
}

TEST_CASE("walls on a floor keep the corners of their holes while their lines may lose vertices") {
  constexpr int k_bays = 10;
  Sheets sheets;
  for (int line = 0; line <= 6 * k_bays; line += 6) {
    for (int bay = 0; bay < 6 * k_bays; bay += 6) {
      sheets.add_bay([&](int i, int k) { return Vec3{1.0 * (bay + i), 1.0 * line, 1.0 * k}; });
      sheets.add_bay([&](int i, int k) { return Vec3{1.0 * line, 1.0 * (bay + i), 1.0 * k}; });
    }
  }
  for (int x = 0; x < 6 * k_bays; x += 6) {
    for (int y = 0; y < 6 * k_bays; y += 6) {
      const auto at = [&](int i, int k) { return Vec3{1.0 * (x + i), 1.0 * (y + k), 0}; };
      sheets.add_bay(at, false);
    }
  }
  const Mesh mesh = sheets.bent([](Vec3 p) {
    return Vec3{p.x, p.y, p.z + 6 * (0.004 * p.x * p.x / 36 + 0.02 * std::sin(p.y / 6))};
  });
  for (const double share : {0.15, 0.13, 0.11}) {
    CAPTURE(share);
    const auto all = static_cast<double>(mesh.triangles.size());
    CHECK(lost_corners(sheets, mesh, static_cast<std::uint64_t>(share * all)) == 0);
  }
}

TEST_CASE("holes of a plate are closed where corners that cost the same would be worse") {
  const Mesh mesh = plate(12);
  // 20 triangles per hole would keep all holes.
  for (const std::uint64_t triangles : {2800U, 2500U, 2000U}) {
    CAPTURE(triangles);
    const double simplified = error_of(mesh, triangles, TopologyMode::simplify);
    CHECK(error_of(mesh, triangles, TopologyMode::automatic) <= 1.25 * simplified);
  }
}
