// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "geometry/simplify/cost_counts.hpp"

using namespace meshfarm;

TEST_CASE("of the costs those near the greatest are dear") {
  CHECK(CostCounts().dear() == 0);
  CostCounts counts;
  for (int i = 0; i < 1000; ++i) counts.add(0);
  CHECK(counts.dear() == 1000);
  for (int i = 0; i < 30; ++i) counts.add(1e-9 * (1 + i));
  CHECK(counts.dear() == 30);
  for (int i = 0; i < 5; ++i) counts.add(6.4e-7);
  CHECK(counts.dear() >= 5 + 21);  // at least a 64th of the greatest
  CHECK(counts.dear() <= 5 + 26);  // at least a 128th
}

TEST_CASE("a share of the costs is below their quantile, and no less below half of it") {
  CostCounts counts;
  for (int i = 1; i <= 1000; ++i) counts.add(3e-12 * i);
  for (const double share : {0.1, 0.5, 0.9}) {
    CAPTURE(share);
    CHECK(counts.quantile(share) >= 3e-9 * share);
    CHECK(counts.quantile(share) <= 2.001 * 3e-9 * share);
  }
  CHECK(CostCounts().quantile(0.5) < 1e-300);
}

TEST_CASE("costs that are none, endless or no numbers are counted") {
  CostCounts counts;
  for (const double cost : {0.0, -0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    counts.add(cost);
  }
  CHECK(counts.quantile(1) < 1e-300);
  counts.add(HUGE_VAL);
  CHECK(counts.dear() == 1);
  CHECK(counts.quantile(1) == HUGE_VAL);
}
