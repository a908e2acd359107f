// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/packed_triangles.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

TEST_CASE("triangles come back, near ones in half the bytes") {
  const std::vector<Triangle> near = test::torus(100, 50).triangles;
  CHECK(pack_triangles(near).size() == near.size() * 6);
  CHECK(unpack_triangles(pack_triangles(near)).value() == near);
  CHECK(unpack_triangles("").value().empty());
}

TEST_CASE("corners as far apart as may be come back") {
  constexpr std::uint32_t k_last = 0xffffffff;
  std::vector<Triangle> far;
  for (const std::uint32_t a : {0U, 1U, 0x7fffU, 0x8000U, 0x8001U, 0x10000U, k_last}) {
    for (const std::uint32_t b : {0U, a, a + 0x7fff, a - 0x7fff, a + 0x8000, a - 0x8000, k_last}) {
      far.push_back({a, b, a});
      far.push_back({b, a, a + 1});
      far.push_back({a, a - 1, b});
    }
  }
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const auto any = [&] { return static_cast<std::uint32_t>(random() >> (random() % 32)); };
    far.push_back({any(), any(), any()});
  }
  CHECK(unpack_triangles(pack_triangles(far)).value() == far);
}

TEST_CASE("bytes that end inside of a triangle are refused") {
  const std::string bytes = pack_triangles(
      std::vector<Triangle>{{1, 2, 3}, {1'000'000, 2, 3}, {1'000'000, 1'000'001, 999'999}});
  REQUIRE(bytes.size() == 6 + 14 + 6);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const bool whole = size == 6 || size == 20 || size == 0;
    CHECK(unpack_triangles(std::string_view(bytes).substr(0, size)).has_value() == whole);
  }
}
