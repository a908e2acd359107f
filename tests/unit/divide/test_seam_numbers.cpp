// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "divide/seam_numbers.hpp"

using namespace meshfarm;

namespace {

/// Share s has boundary vertices at 10 and 20, and two at one point, 30 and 40, that stay apart.
BoundaryNumbers numbers_of(std::uint32_t share) {
  return {{10, 20, 30, 40}, {share, share + 1, share + 2, share + 3}, {0, 1, 2, 2}};
}

}  // namespace

TEST_CASE("corners get the numbers of their shares, and the order stays") {
  SeamNumbers numbers(3, numbers_of);
  const Seams seams{{{{{0, 20}, {1, 10}, {2, 40}}},
                     {{{2, 10}, {0, 10}, {0, 20}}},
                     {{{1, 10}, {1, 10}, {0, 40}}},
                     {{{1, 30}, {1, 40}, {0, 40}}}},
                    {{5, 6, 7, 8}, {}}};
  const SharedTriangles made = numbers.number(seams);
  CHECK(made.triangles == std::vector<BoundaryTriangle>{{{{0, 1}, {1, 1}, {2, 5}}},
                                                        {{{2, 2}, {0, 0}, {0, 1}}},
                                                        {{{1, 3}, {1, 4}, {0, 3}}}});
  CHECK(made.columns.labels == std::vector<Label>{5, 6, 8});
  CHECK(made.degenerate == 1);
  CHECK(made.coincident == 2);  // that one, and the one whose corners stay apart
}

TEST_CASE("numbers are loaded once while they are needed, and again after") {
  std::vector<int> loads(3, 0);
  SeamNumbers numbers(3, [&](std::uint32_t share) {
    ++loads[share];
    return numbers_of(share);
  });
  const Seams lower{{{{{0, 10}, {1, 10}, {1, 20}}}}, {}};
  const Seams upper{{{{{1, 10}, {2, 10}, {2, 20}}}}, {}};
  for (const Seams& each : {lower, upper, upper, lower}) {
    numbers.number(each);
    numbers.forget_unused();
  }
  CHECK(loads == std::vector<int>{2, 1, 1});
}

TEST_CASE("corners without a number are refused") {
  SeamNumbers numbers(2, numbers_of);
  for (const SharePlace& wrong : {SharePlace{0, 15}, SharePlace{0, 41}, SharePlace{2, 10}}) {
    const Seams seams{{{{{1, 10}, {1, 20}, wrong}}}, {}};
    CHECK_THROWS_AS(numbers.number(seams), DataError);
  }
}
