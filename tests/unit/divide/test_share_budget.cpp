// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "divide/share_budget.hpp"

using namespace meshfarm;

TEST_CASE("there are as many slabs as are wanted, or so many that one fits into half the memory") {
  const ShareBudget budget{.memory_bytes = 2'000'000, .bytes_per_triangle = 100};
  CHECK(budget.slabs(5'000, 3) == 3);
  CHECK(budget.slabs(1'000'000, 3) == 101);
  CHECK(budget.slabs(1'000'000'000'000, 3) == k_most_slabs);
  CHECK(budget.slabs(0, 1) == 1);
  CHECK(ShareBudget{}.slabs(10, 2) == 2);
}

TEST_CASE("so many slabs are sorted at once as fit into the memory") {
  const ShareBudget budget{.memory_bytes = 1'000'000, .bytes_per_triangle = 100};
  CHECK(budget.threads(10'000, 4, 8) == 4);
  CHECK(budget.threads(10'000, 4, 2) == 2);
  CHECK(budget.threads(1'000'000, 4, 8) == 1);
  CHECK(budget.threads(0, 0, 3) == 3);
  CHECK(budget.threads(0, 0, 0) >= 1);
}
