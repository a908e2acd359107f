// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <memory>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/near_vertices.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::size_t places_of(const Mesh& mesh) {
  const WeldResult welded = weld(mesh.positions);
  return mesh.positions.size() - welded.merged;
}

Mesh in_floats(Mesh mesh) {
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  return mesh;
}

Mesh merged(const Mesh& mesh, PositionType type, const NearMerging& options,
            NearMerges* made = nullptr) {
  auto source = std::make_unique<test::MemorySource>(mesh, type);
  const Box box = vertex_box(*source);
  const auto near = with_near_merged(std::move(source), box, options);
  if (made != nullptr) *made = near->info().near_merges;
  CHECK(near->info().vertices == mesh.positions.size());
  return read_mesh(*near);
}

}  // namespace

TEST_CASE("near vertices: corners that miss each other are found and merged") {
  const Mesh sphere = test::icosphere(4);
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    Mesh soup = test::jittered_soup(sphere, 1e-6);
    if (type == PositionType::float32) soup = in_floats(std::move(soup));
    test::MemorySource source(soup, type);
    CHECK(may_have_near_misses(source.info()));
    const double distance = find_near_misses(source, vertex_box(source));
    REQUIRE(distance > 1e-6);
    NearMerges made;
    const Mesh all = merged(soup, type, {distance}, &made);
    CHECK(all.triangles == soup.triangles);
    CHECK(places_of(soup) > 2 * sphere.triangles.size());
    CHECK(places_of(all) == sphere.positions.size());
    CHECK(made.distance == distance);
    std::uint64_t moved = 0;
    for (std::size_t v = 0; v < all.positions.size(); ++v) {
      CHECK(length(all.positions[v] - soup.positions[v]) <= distance);
      moved += all.positions[v] == soup.positions[v] ? 0 : 1;
    }
    CHECK(made.vertices == moved);
  }
}

TEST_CASE("near vertices: meshes whose triangles share vertices are not looked at") {
  CHECK_FALSE(may_have_near_misses(test::MemorySource(test::icosphere(3)).info()));
}

TEST_CASE("near vertices: the number of threads and slabs does not show") {
  // More than a million vertices: more than one slab.
  const Mesh sphere = test::icosphere(7);
  const Mesh soup = in_floats(test::jittered_soup(sphere, 1e-6));
  REQUIRE(soup.positions.size() > 900'000);
  Mesh two = soup;
  test::append(two, in_floats(test::jittered_soup(test::icosphere(6), 2e-6)));
  REQUIRE(two.positions.size() > std::size_t{1} << 20);
  const Mesh one = merged(two, PositionType::float32, {1e-5, 1, {}});
  CHECK(one.positions == merged(two, PositionType::float32, {1e-5, 3, {}}).positions);
  CHECK(places_of(one) == sphere.positions.size());
}

TEST_CASE("near vertices: vertices without a position stay so, and lists may be empty") {
  Mesh soup = test::jittered_soup(test::octahedron(), 1e-6);
  soup.positions[4] = k_no_position;
  test::MemorySource source(soup);
  const auto near =
      with_near_merged(std::make_unique<test::MemorySource>(soup), vertex_box(source), {1e-5});
  std::vector<Vec3> all;
  near->scan_vertices(
      [&](std::span<const Vec3> batch) { all.insert(all.end(), batch.begin(), batch.end()); });
  REQUIRE(all.size() == soup.positions.size());
  CHECK_FALSE(has_position(all[4]));
  CHECK(read_mesh(*near).triangles.size() == soup.triangles.size() - 1);
  CHECK(merged({}, PositionType::float64, {1e-5}).positions.empty());
}

TEST_CASE("near vertices: progress rises, and may end it") {
  const Mesh soup = test::jittered_soup(test::icosphere(3), 1e-6);
  double last = 0;
  const auto rises = [&](double done) {
    CHECK(done >= last);
    CHECK(done <= 1);
    last = done;
  };
  merged(soup, PositionType::float64, {1e-5, 1, rises});
  CHECK(last >= 0.5);
  const auto ends = [](double) { throw std::runtime_error("stop"); };
  CHECK_THROWS_AS(merged(soup, PositionType::float64, {1e-5, 1, ends}), std::runtime_error);
}
