// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

constexpr std::array k_shapes{Shape::torus,   Shape::foam,  Shape::dust, Shape::soup,
                              Shape::terrain, Shape::block, Shape::shell};
constexpr std::array k_closed{Shape::torus, Shape::foam, Shape::dust, Shape::block, Shape::shell};

Mesh make_shape(Shape shape, std::uint64_t triangles) {
  return in_memory(*generate_mesh(shape, triangles));
}

Vec3 shape_normal(const Mesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.positions[t[0]];
  return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    volume += dot(mesh.positions[t[0]], shape_normal(mesh, t)) / 6;
  }
  return volume;
}

double diagonal_of(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box.diagonal();
}

template <class Holds>
double share_of_area(const Mesh& mesh, const Holds& holds) {
  double all = 0, held = 0;
  for (const Triangle& t : mesh.triangles) {
    const double area = length(shape_normal(mesh, t));
    all += area;
    if (holds(t)) held += area;
  }
  return held / all;
}

/// A checksum of positions and triangles, which does not depend on the batches.
std::string checksum_of(const Mesh& mesh) {
  std::string bytes(mesh.positions.size() * sizeof(Vec3), '\0');
  std::memcpy(bytes.data(), mesh.positions.data(), bytes.size());
  std::string corners(mesh.triangles.size() * sizeof(Triangle), '\0');
  std::memcpy(corners.data(), mesh.triangles.data(), corners.size());
  return to_hex(checksum(bytes + corners));
}

double genus_of(const Topology& t) {
  return static_cast<double>(t.components) - static_cast<double>(t.euler) / 2;
}

}  // namespace

TEST_CASE("shapes: their names") {
  CHECK(shape_named("foam") == Shape::foam);
  CHECK(shape_named("shell") == Shape::shell);
  CHECK_THROWS_WITH_AS(shape_named("cube"), doctest::Contains("torus, foam, dust"), UsageError);
}

TEST_CASE("shapes: about as many triangles as asked for, at any size") {
  for (const Shape shape : k_shapes) {
    CAPTURE(static_cast<int>(shape));
    for (const std::uint64_t wanted : {1'000U, 1'700U, 5'000U, 10'000U, 23'456U, 300'000U}) {
      CAPTURE(wanted);
      const double got = static_cast<double>(generate_mesh(shape, wanted)->triangles()) /
                         static_cast<double>(wanted);
      CHECK(got == doctest::Approx(1).epsilon(wanted < 10'000 ? 0.15 : 0.03));
    }
    CHECK_THROWS_AS(generate_mesh(shape, 100), UsageError);
    CHECK_THROWS_AS(generate_mesh(shape, ~std::uint64_t{0}), UsageError);
  }
}

TEST_CASE("shapes: as many vertices and triangles as promised, in small batches") {
  for (const Shape shape : k_shapes) {
    CAPTURE(static_cast<int>(shape));
    const auto made = generate_mesh(shape, 60'000);
    std::uint64_t vertices = 0, triangles = 0;
    bool small = true, in_range = true, are_floats = true;
    made->for_vertices([&](std::span<const Vec3> batch) {
      vertices += batch.size();
      small = small && !batch.empty() && batch.size() <= 1 << 14;
      for (const Vec3& p : batch) {
        are_floats = are_floats && p == rounded(p, PositionType::float32);
      }
    });
    made->for_triangles([&](std::span<const GeneratedMesh::Corners> batch) {
      triangles += batch.size();
      small = small && !batch.empty() && batch.size() <= 1 << 14;
      for (const auto& t : batch)
        in_range = in_range && *std::max_element(t.begin(), t.end()) < vertices;
    });
    CHECK(small);
    CHECK(are_floats);
    CHECK(in_range);
    CHECK(vertices == made->vertices());
    CHECK(triangles == made->triangles());
  }
}

TEST_CASE("shapes: no vertex unused, no triangle degenerate, none twice, none turned over") {
  for (const Shape shape : k_shapes) {
    for (const std::uint64_t wanted : {1'000U, 50'000U}) {
      CAPTURE(static_cast<int>(shape));
      CAPTURE(wanted);
      const Topology t = measure_topology(make_shape(shape, wanted));
      CHECK(t.used_vertices == t.vertices);
      CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
      CHECK(t.nonmanifold_edges + t.orientation_conflicts == 0);
    }
  }
}

TEST_CASE("shapes: closed ones are closed and face outwards") {
  for (const Shape shape : k_closed) {
    CAPTURE(static_cast<int>(shape));
    const Mesh mesh = make_shape(shape, 50'000);
    CHECK(measure_topology(mesh).border_edges == 0);
    CHECK(volume_of(mesh) > 0);
  }
}

TEST_CASE("shapes: the same on every machine") {
  const auto is = [](Shape shape, std::string_view sum) {
    CAPTURE(static_cast<int>(shape));
    CHECK(checksum_of(make_shape(shape, 20'000)) == sum);
  };
  is(Shape::torus, "1cc8b6aad316c76e");
  is(Shape::foam, "225b2c9ef25bf8f3");
  is(Shape::dust, "cf3613bae8586b44");
  is(Shape::soup, "2fe385f1bf766b07");
  is(Shape::terrain, "09f13443257be086");
  is(Shape::block, "b225d94e1080f000");
  is(Shape::shell, "3a4e3c35522285ee");
}

TEST_CASE("foam: handles in proportion to the triangles") {
  const double few = genus_of(measure_topology(make_shape(Shape::foam, 50'000)));
  const double many = genus_of(measure_topology(make_shape(Shape::foam, 500'000)));
  CHECK(few > 40);
  CHECK(many > 10 * few);  // the box's walls have no handles, and matter less
  CHECK(many < 20 * few);
}

TEST_CASE("dust: a quarter of the triangles are specks, clear of the surface") {
  Mesh mesh = make_shape(Shape::dust, 40'000);
  const Topology t = measure_topology(mesh);
  CHECK(t.components == 1 + 10'000 / 8);
  const double all = diagonal_of(mesh);
  const DroppedComponents specks = drop_small_components(mesh, 0.05 * all);
  CHECK(specks.components == t.components - 1);
  CHECK(specks.triangles == doctest::Approx(10'000).epsilon(0.01));
}

TEST_CASE("soup: a weld joins nothing") {
  const Mesh mesh = make_shape(Shape::soup, 20'000);
  CHECK(mesh.positions.size() == 3 * mesh.triangles.size());
  CHECK(weld(mesh.positions).merged == 0);
}

TEST_CASE("terrain: one sheet, one border, rough land and flat lakes") {
  const Mesh mesh = make_shape(Shape::terrain, 100'000);
  const Topology t = measure_topology(mesh);
  CHECK(t.components == 1);
  CHECK(t.euler == 1);
  CHECK(t.border_edges < 1'000);
  const double lakes = share_of_area(mesh, [&](const Triangle& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t v) { return mesh.positions[v].z == 0; });
  });
  CHECK(lakes > 0.1);
  CHECK(lakes < 0.5);
  const double steep = share_of_area(mesh, [&](const Triangle& corners) {
    const Vec3 n = shape_normal(mesh, corners);
    return n.z < 0.7 * length(n);
  });
  CHECK(steep > 0.1);
  CHECK(share_of_area(mesh, [&](const Triangle& c) { return shape_normal(mesh, c).z > 0; }) == 1);
}

TEST_CASE("block: six holes, exactly flat faces, right angles") {
  for (const std::uint64_t wanted : {1'000U, 30'000U}) {
    const Mesh mesh = make_shape(Shape::block, wanted);
    CHECK(genus_of(measure_topology(mesh)) == 6);
    const double flat = share_of_area(mesh, [&](const Triangle& corners) {
      const Vec3 n = shape_normal(mesh, corners);
      return (n.x != 0) + (n.y != 0) + (n.z != 0) == 1;
    });
    CHECK(flat > 0.5);
    CHECK(flat < 0.95);
    CHECK(volume_of(mesh) > 2);  // 3 before the holes
    CHECK(volume_of(mesh) < 2.6);
  }
}

TEST_CASE("shell: two sheets a ten-thousandth apart, which do not meet") {
  const Mesh both = make_shape(Shape::shell, 40'000);
  CHECK(measure_topology(both).components == 2);
  // Rings of the two sheets alternate: a triangle's place in the file tells its sheet.
  Mesh outer{both.positions, {}}, inner{both.positions, {}};
  for (std::size_t i = 0; i < both.triangles.size(); ++i) {
    (i % 4 < 2 ? outer : inner).triangles.push_back(both.triangles[i]);
  }
  CHECK(volume_of(outer) > -volume_of(inner));
  DistanceOptions options;
  options.samples = 20'000;
  const Distance apart = measure_distance(inner, outer, options);
  const double diagonal = diagonal_of(both);
  CHECK(apart.mean > 0.7e-4 * diagonal);
  CHECK(apart.max < 1.5e-4 * diagonal);
}
