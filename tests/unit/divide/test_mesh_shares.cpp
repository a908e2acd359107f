// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "divide/mesh_shares.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Resident bytes: "RssFile:" of mapped files, "RssAnon:" of memory.
std::uint64_t resident_bytes(std::string_view kind) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != kind) continue;
    std::uint64_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes << 10;
  }
  return 0;
}

}  // namespace

TEST_CASE("a large map is not held in memory, and knows all vertices") {
  constexpr std::uint32_t k_batch = 1 << 16;
  constexpr std::uint32_t k_batches = 400;  // 200 MB of map
  const test::TempFolder folder;
  MeshShares shares({folder.path(), 2, std::uint64_t{k_batch} * k_batches});
  const std::uint64_t before = resident_bytes("RssFile:");
  std::uint64_t most = before;
  std::vector<Vec3> batch(k_batch);
  for (std::uint32_t i = 0; i < k_batches; ++i) {
    // Only the first vertex of each batch belongs to a share.
    std::vector<std::uint32_t> where(k_batch, MeshShares::k_no_share);
    where[0] = i % 2;
    batch[0] = {1.0 * i, 0, 0};
    shares.add_vertices(batch, where);
    most = std::max(most, resident_bytes("RssFile:"));
  }
  CHECK(most < before + (std::uint64_t{80} << 20));
  for (std::uint64_t i = 0; i + 4 < k_batches; ++i) {
    const WideTriangle even = {i * k_batch, (i + 2) * k_batch, (i + 4) * k_batch};
    shares.add_triangles(std::span(&even, 1));
  }
  shares.finish();
  for (const std::uint32_t share : {0U, 1U}) {
    const MeshShare read = shares.read(share, Weld::off);
    REQUIRE(read.positions.size() == k_batches / 2);
    CHECK(read.positions[7].x == 14 + share);
    REQUIRE(read.triangles.size() == k_batches / 2 - 2);
    CHECK(read.triangles[9] == Triangle{9, 10, 11});
  }
}

TEST_CASE("boundary triangles are not held in memory") {
  constexpr std::uint32_t k_batch = 100'000;
  constexpr std::uint32_t k_batches = 60;  // 144 MB of triangles
  const test::TempFolder folder;
  const std::uint64_t before = resident_bytes("RssAnon:");
  MeshShares shares({.folder = folder.path(), .shares = 3, .vertices = 6});
  const std::vector<Vec3> positions(6);
  shares.add_vertices(positions, std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2});
  const std::vector<WideTriangle> even(k_batch, {0, 2, 4});
  const std::vector<WideTriangle> odd(k_batch, {1, 2, 4});
  for (std::uint32_t i = 0; i < k_batches; ++i) shares.add_triangles(i % 2 == 0 ? even : odd);
  CHECK(resident_bytes("RssAnon:") < before + (std::uint64_t{60} << 20));
  shares.finish();
  for (const std::uint32_t share : {0U, 1U, 2U}) {
    const std::vector<SeamTriangle> seam = shares.seam(share);
    REQUIRE(seam.size() == std::size_t{k_batch} * k_batches);
    CHECK(seam.front() == SeamTriangle{{{0, 0}, {1, 0}, {2, 0}}});
    CHECK(seam.back() == SeamTriangle{{{0, 1}, {1, 0}, {2, 0}}});
  }
  CHECK(shares.read(0, Weld::off).boundary.size() == std::size_t{k_batch} * k_batches);
  CHECK(shares.region(0).triangles == shares.seam(0));
  CHECK(shares.region(1).triangles.empty());
}

TEST_CASE("boundary triangles are told by region, with their labels, in file order") {
  const test::TempFolder folder;
  MeshShares shares({.folder = folder.path(),
                     .shares = 3,
                     .vertices = 3,
                     .columns = {.labels = true, .uvs = false}});
  const std::vector<Vec3> positions(3);
  shares.add_vertices(positions, std::vector<std::uint32_t>{0, 1, 2});
  const std::vector<WideTriangle> triangles = {{1, 2, 2}, {0, 1, 2}, {2, 1, 1}, {1, 1, 0}};
  const std::vector<Label> labels = {4, 5, 6, 7};
  shares.add_triangles({triangles, {labels, {}}});
  shares.finish();
  const Seams outer = shares.region(0);
  CHECK(outer.triangles ==
        std::vector<SeamTriangle>{{{{0, 0}, {1, 0}, {2, 0}}}, {{{1, 0}, {1, 0}, {0, 0}}}});
  CHECK(outer.columns.labels == std::vector<Label>{5, 7});
  const Seams inner = shares.region(1);
  CHECK(inner.triangles ==
        std::vector<SeamTriangle>{{{{1, 0}, {2, 0}, {2, 0}}}, {{{2, 0}, {1, 0}, {1, 0}}}});
  CHECK(inner.columns.labels == std::vector<Label>{4, 6});
}

TEST_CASE("vertices of one point become one") {
  const test::TempFolder folder;
  constexpr std::uint32_t k_none = MeshShares::k_no_point;
  MeshShares shares({folder.path(), 2, 6});
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                       {5, 5, 5}, {5, 5, 5}, {5, 5, 5}};
  const std::vector<std::uint32_t> where = {0, 0, 0, 0, 0, 0};
  const std::vector<std::uint32_t> points = {k_none, k_none, k_none, 7, 7, 7};
  shares.add_vertices(positions, where, points);
  const std::vector<WideTriangle> triangles = {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}, {0, 4, 5}};
  shares.add_triangles(triangles);
  shares.finish();
  CHECK(shares.merged() == 2);
  const MeshShare read = shares.read(0, Weld::off);
  CHECK(read.positions.size() == 4);
  CHECK(read.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 3, 3}});
}

TEST_CASE("triangles that are points are left out and counted") {
  const test::TempFolder folder;
  MeshShares shares({folder.path(), 2, 6});
  constexpr std::uint32_t k_none = MeshShares::k_no_point;
  const std::vector<Vec3> positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                       {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const std::vector<std::uint32_t> where = {0, 0, 0, 0, 0, 1};
  const std::vector<std::uint32_t> points = {4, 4, 4, k_none, k_none, k_none};
  shares.add_vertices(positions, where, points);
  const std::vector<WideTriangle> triangles{{0, 1, 2}, {0, 3, 4}, {3, 3, 3},
                                            {3, 3, 4}, {5, 5, 5}, {0, 1, 5}};
  shares.add_triangles(triangles);
  shares.finish();
  CHECK(shares.points_left_out() == 3);
  CHECK(shares.read(0, Weld::off).triangles.size() == 2);
  CHECK(shares.read(1, Weld::off).triangles.empty());
  CHECK(shares.seam(1).size() == 1);
}

TEST_CASE("each vertex of a share has its appearance, in memory and in scratch files") {
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 20}) {
    const test::TempFolder folder;
    MeshShares shares({folder.path(), 2, 5, PositionType::float32, memory,
                       MeshShares::SeamsFor::shares_and_regions, true});
    const std::vector<Vec3> positions(5);
    const std::vector<Appearance> appearances = test::appearances(5);
    shares.add_vertices({positions, appearances},
                        std::vector<std::uint32_t>{0, 1, MeshShares::k_no_share, 1, 0});
    shares.finish();
    CHECK(shares.read(0, Weld::off).appearances == std::vector{appearances[0], appearances[4]});
    CHECK(shares.read(1, Weld::off).appearances == std::vector{appearances[1], appearances[3]});
  }
}
