// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <vector>

#include <doctest/doctest.h>

#include "pipeline/quotas.hpp"

using namespace meshfarm;

namespace {

std::uint64_t sum_of_all(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

/// Flat, even and rough; the last has an open border.
std::vector<PieceWeight> three_weights() {
  return {{1000, 4, {900, 400, 100}}, {1000, 4, {1000, 800, 600}}, {1001, 5, {960, 900}}};
}

}  // namespace

TEST_CASE("a weight is known at every step") {
  const PieceWeight weight{1000, 4, {900, 400, 100}};
  CHECK(weight.at(0) == 1000);
  CHECK(weight.at(3) == 1000);
  CHECK(weight.at(4) == 900);
  CHECK(weight.at(6) == 100);
  CHECK(weight.at(60) == 100);
  CHECK_FALSE(weight.can_be_odd());
  CHECK(PieceWeight{1001, 5, {960}}.can_be_odd());
  CHECK(PieceWeight{1000, 5, {960}, true}.can_be_odd());
}

TEST_CASE("quotas lie between two steps that are the same for all") {
  const std::vector<PieceWeight> pieces = three_weights();
  // At step 4: 900 + 1000 + 1001; at step 5: 400 + 800 + 960; at step 6: 100 + 600 + 900.
  for (const std::uint64_t target : {2161U, 2500U, 2901U, 1601U, 1900U, 2159U, 3000U}) {
    CAPTURE(target);
    const std::vector<std::uint64_t> quotas = share_out_triangles(pieces, target);
    CHECK(sum_of_all(quotas) == target);
    const std::int32_t step = target > 2160 ? 5 : 6;
    for (std::size_t i = 0; i < 3 && target < 2901; ++i) {
      CHECK(quotas[i] + 4 >= pieces[i].at(step));
      CHECK(quotas[i] <= pieces[i].at(step - 1) + 4);
    }
  }
}

TEST_CASE("inside a surface triangles go in pairs") {
  std::vector<PieceWeight> pieces = three_weights();
  pieces.pop_back();
  for (std::uint64_t target = 700; target < 2000; target += 7) {
    CAPTURE(target);
    const std::vector<std::uint64_t> quotas = share_out_triangles(pieces, target);
    CHECK(sum_of_all(quotas) == target - target % 2);
    for (const std::uint64_t quota : quotas) CHECK(quota % 2 == 0);
  }
}

TEST_CASE("below the last step all give the same share") {
  const std::vector<std::uint64_t> quotas = share_out_triangles(three_weights(), 800);
  CHECK(sum_of_all(quotas) == 800);
  CHECK(quotas[0] <= 52);
  CHECK(quotas[2] >= 446);
}

TEST_CASE("what one piece cannot give others do") {
  const std::vector<PieceWeight> pieces = three_weights();
  const std::vector<std::uint64_t> quotas = {400, 800, 960};
  const std::vector<std::uint64_t> again = share_out_again(pieces, quotas, {{420, 800, 960}});
  REQUIRE(again.size() == 3);
  CHECK(again[0] == 400);
  CHECK(420 + again[1] + again[2] == 2160);
  CHECK(share_out_again(pieces, quotas, {{400, 800, 960}}) == quotas);
  CHECK(share_out_again(pieces, quotas, {{400, 2800, 960}}).empty());
}

TEST_CASE("where no border can change, a piece gives its last two triangles at once") {
  const std::vector<PieceWeight> piece = {three_weights().front()};
  const std::vector<std::uint64_t> again = share_out_again(piece, {{401}}, {{402}});
  REQUIRE(again.size() == 1);
  CHECK(again[0] == 400);
  CHECK(share_out_again(piece, again, {{402}}).empty());
  CHECK(share_out_again(piece, {{0}}, {{1}}).empty());
}

TEST_CASE("no pieces, and more than there is") {
  CHECK(share_out_triangles({}, 10).empty());
  CHECK(sum_of_all(share_out_triangles(three_weights(), 5000)) == 3001);
}
