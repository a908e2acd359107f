// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include "pipeline/knee.hpp"

using namespace meshfarm;

TEST_CASE("the counts that are looked at rise from the goal by quarters") {
  const std::vector<std::uint64_t> counts = counts_before_knee(1000);
  REQUIRE(counts.size() > 3);
  CHECK(counts.back() == 1250);
  CHECK(counts[counts.size() - 2] == 1562);
  CHECK(std::is_sorted(counts.rbegin(), counts.rend()));
  CHECK(counts_before_knee(2'000'000).empty());
}

TEST_CASE("half as many triangles more are a little more, twice as many are not") {
  CHECK(is_a_little_more(1000, 1000));
  CHECK(is_a_little_more(1000, 1500));
  CHECK_FALSE(is_a_little_more(1000, 2000));
}

TEST_CASE("a knee is told of where it shows and little would mend it") {
  CHECK(is_past_knee({4000, 2.7e-2}, {5200, 3.1e-4}));
  CHECK_FALSE(is_past_knee({4000, 2.7e-2}, {5200, 1e-2}));
  CHECK_FALSE(is_past_knee({4000, 2.7e-2}, {9000, 1e-3}));
  CHECK_FALSE(is_past_knee({4000, 2.7e-2}, {4000, 3.1e-4}));
  CHECK(is_visible(2.7e-4));
  CHECK_FALSE(is_visible(2.7e-5));
  CHECK_FALSE(is_plain(2.7e-4));
}
