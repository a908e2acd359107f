// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/fans.hpp"

using namespace meshfarm;

namespace {

using Kind = FanSplitter::Kind;

/// A splitter that has split these corners.
FanSplitter splitter_of(const std::vector<Corner>& corners) {
  FanSplitter splitter;
  splitter.split(corners);
  return splitter;
}

std::vector<std::uint32_t> fans_of(const std::vector<Corner>& corners) {
  FanSplitter splitter;
  const std::uint32_t fans = splitter.split(corners);
  std::vector<std::uint32_t> each(splitter.fans().begin(), splitter.fans().end());
  CHECK(fans == (each.empty() ? 0 : *std::max_element(each.begin(), each.end()) + 1));
  return each;
}

using Fans = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("fans: once round is closed, in whatever order") {
  const std::vector<Corner> corners{{1, 2}, {3, 4}, {2, 3}, {4, 1}};
  CHECK(fans_of(corners) == Fans{0, 0, 0, 0});
  CHECK(splitter_of(corners).kind() == Kind::closed);
  CHECK(!splitter_of(corners).has_turned());
}

TEST_CASE("fans: with two ends it is open") {
  const std::vector<Corner> corners{{2, 3}, {1, 2}, {3, 4}};
  CHECK(fans_of(corners) == Fans{0, 0, 0});
  CHECK(splitter_of(corners).kind() == Kind::open);
  CHECK(splitter_of({{1, 2}}).kind() == Kind::open);
}

TEST_CASE("fans: a bow tie is two, numbered in the order of their first corners") {
  // Two closed ones.
  const std::vector<Corner> closed{{1, 2}, {4, 5}, {2, 3}, {5, 6}, {3, 1}, {6, 4}};
  CHECK(fans_of(closed) == Fans{0, 1, 0, 1, 0, 1});
  CHECK(splitter_of(closed).kind() == Kind::complex);
  // Two open ones.
  const std::vector<Corner> open{{1, 2}, {3, 4}, {2, 5}};
  CHECK(fans_of(open) == Fans{0, 1, 0});
  CHECK(splitter_of(open).kind() == Kind::complex);
}

// Neighbour 1 is across an edge of four triangles:
//
//     2 - 1 - 4
//      \ /|\ /
//       3 | 5
TEST_CASE("fans: of two closed ones that share an edge each closes on itself") {
  const std::vector<Corner> corners{{1, 2}, {2, 3}, {3, 1}, {1, 4}, {4, 5}, {5, 1}};
  CHECK(fans_of(corners) == Fans{0, 0, 0, 1, 1, 1});
  CHECK(splitter_of(corners).kind() == Kind::complex);
  const std::span<const Corner> all(corners);
  FanSplitter one;
  CHECK(one.split(all.first(3)) == 1);
  CHECK(one.kind() == Kind::closed);
}

TEST_CASE("fans: sheets that meet in an edge belong together") {
  const std::vector<Corner> three{{1, 2}, {3, 1}, {4, 1}};
  CHECK(fans_of(three) == Fans{0, 0, 0});
  CHECK(splitter_of(three).kind() == Kind::complex);
  // A closed fan and a wing at one of its edges: the wing is a fan of its own.
  const std::vector<Corner> wing{{1, 2}, {2, 3}, {3, 1}, {1, 4}};
  CHECK(fans_of(wing) == Fans{0, 0, 0, 1});
}

TEST_CASE("fans: neighbours that face opposite ways are told") {
  const std::vector<Corner> corners{{1, 2}, {3, 2}, {3, 1}};
  CHECK(fans_of(corners) == Fans{0, 0, 0});
  CHECK(splitter_of(corners).has_turned());
  CHECK(splitter_of(corners).kind() == Kind::complex);
  // A chain that begins and ends at an edge of four triangles is not closed if it does not face
  // the same way throughout.
  const std::vector<Corner> seam{{1, 2}, {3, 2}, {1, 3}, {1, 4}, {4, 5}, {5, 1}};
  CHECK(fans_of(seam) == Fans{0, 0, 0, 1, 1, 1});
}

TEST_CASE("fans: nothing is no fan") {
  FanSplitter splitter;
  CHECK(splitter.split({}) == 0);
  CHECK(splitter.fans().empty());
  CHECK(splitter.kind() == Kind::closed);
}
