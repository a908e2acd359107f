// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/geometry/weighted_values.hpp>

namespace meshfarm {
namespace {

TEST_CASE("a quantile of weighted values is by weight, not by their number") {
  const WeightedValues values({{3, 1}, {1, 97}, {2, 2}});
  CHECK(values.weight() == 100);
  CHECK(values.quantile(0.95) == 1);
  CHECK(values.quantile(0.98) == 2);
  CHECK(values.quantile(0.995) == 3);
  CHECK(values.quantile(1) == 3);
  CHECK(WeightedValues({}).quantile(0.5) == 0);
}

}  // namespace
}  // namespace meshfarm
