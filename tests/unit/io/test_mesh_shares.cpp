// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/io/mesh_shares.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Pages of files that are mapped and resident.
std::uint64_t mapped_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "RssFile:") continue;
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
  const std::uint64_t before = mapped_bytes();
  std::uint64_t most = before;
  std::vector<Vec3> batch(k_batch);
  for (std::uint32_t i = 0; i < k_batches; ++i) {
    // The first vertex of each batch counts.
    std::vector<std::uint32_t> where(k_batch, MeshShares::k_no_share);
    where[0] = i % 2;
    batch[0] = {1.0 * i, 0, 0};
    shares.add_vertices(batch, where);
    most = std::max(most, mapped_bytes());
  }
  CHECK(most < before + (std::uint64_t{80} << 20));
  for (std::uint64_t i = 0; i + 4 < k_batches; ++i) {
    const WideTriangle even = {i * k_batch, (i + 2) * k_batch, (i + 4) * k_batch};
    shares.add_triangles({&even, 1});
  }
  shares.finish();
  for (const std::uint32_t share : {0U, 1U}) {
    const MeshShare read = shares.read(share);
    REQUIRE(read.positions.size() == k_batches / 2);
    CHECK(read.positions[7].x == 14 + share);
    REQUIRE(read.triangles.size() == k_batches / 2 - 2);
    CHECK(read.triangles[9] == Triangle{9, 10, 11});
  }
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
  const MeshShare read = shares.read(0);
  CHECK(read.positions.size() == 4);
  CHECK(read.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 3, 3}});
}
