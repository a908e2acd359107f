// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdlib>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "io/vertex_store.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::uint64_t k_too_many_for_memory = std::uint64_t{3} << 20;

/// Fills with 10,000 vertices; `is_final`: the values read are final.
std::uint64_t fill(VertexStore& store, const VertexStore::Filling& filling, bool is_final = true) {
  std::uint64_t taken = 0;
  store.fill(
      filling, [&taken](std::span<const Vec3> batch) { taken += batch.size(); },
      [&](const VertexStore::Take& pass) {
        for (int i = 0; i < 10'000; i += 100) {
          std::vector<Vec3> batch;
          for (int j = i; j < i + 100; ++j) batch.push_back({0.5 * j, 1.0 * j, 0});
          pass(batch);
        }
        return is_final;
      });
  return taken;
}

}  // namespace

TEST_CASE("kept vertices are scanned and found again, in memory and in scratch") {
  for (const std::uint64_t promised : {std::uint64_t{10'000}, k_too_many_for_memory}) {
    VertexStore store;
    CHECK(fill(store, {PositionType::float32, promised, VertexStore::Keep::where_possible}) ==
          10'000);
    REQUIRE(store.is_filled());
    std::vector<Vec3> all;
    store.scan(
        [&all](std::span<const Vec3> batch) { all.insert(all.end(), batch.begin(), batch.end()); });
    REQUIRE(all.size() == 10'000);
    CHECK(all[9'999] == Vec3{4999.5, 9999, 0});
    for (const std::uint64_t v : {9'999U, 0U, 1'234U}) CHECK(store.at(v) == all[v]);
  }
}

TEST_CASE("nothing is kept that is not wanted, or not final") {
  VertexStore store;
  CHECK(fill(store, {PositionType::float32, 10'000, VertexStore::Keep::no}) == 10'000);
  CHECK_FALSE(store.is_filled());
  fill(store, {PositionType::float32, 10'000, VertexStore::Keep::always}, false);
  CHECK_FALSE(store.is_filled());
}

TEST_CASE("without a place for scratch a scan goes on, unless all must be kept") {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", "/no/such/folder", 1);
  const Quiet quiet;
  VertexStore store;
  CHECK(fill(store, {PositionType::float32, k_too_many_for_memory,
                     VertexStore::Keep::where_possible}) == 10'000);
  CHECK_FALSE(store.is_filled());
  CHECK_THROWS_AS(
      fill(store, {PositionType::float32, k_too_many_for_memory, VertexStore::Keep::always}),
      IoError);
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
}
