// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/weighted_values.hpp>

namespace meshfarm {
namespace {

TEST_CASE("a quantile of weighted values is by weight, not by their number") {
  WeightedValues values({{3, 1}, {1, 97}, {2, 2}});
  CHECK(values.weight() == 100);
  CHECK(values.quantile(0.95) == 1);
  CHECK(values.quantile(0.98) == 2);
  CHECK(values.quantile(0.995) == 3);
  CHECK(values.quantile(1) == 3);
  CHECK(WeightedValues({}).quantile(0.5) == 0);
}

TEST_CASE("quantiles of many values, some of them equal, are those of the values in order") {
  std::vector<std::pair<double, double>> of;
  for (int i = 0; i < 5000; ++i) of.emplace_back(std::floor(900 * std::sin(i)), 1 + i % 7);
  WeightedValues values(of);
  std::sort(of.begin(), of.end());
  for (const double share : {0.99, 0.0, 0.5, 0.01, 0.95, 1.0}) {
    double before = 0;
    const auto found = std::find_if(of.begin(), of.end(), [&](const auto& value) {
      before += value.second;
      return before >= share * values.weight();
    });
    CAPTURE(share);
    CHECK(values.quantile(share) == found->first);
  }
}

}  // namespace
}  // namespace meshfarm
