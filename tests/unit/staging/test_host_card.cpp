// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a host card comes back as it was, and damaged not at all") {
  const HostCard card{"pc7", 42, 1'000, 2'000};
  const std::string file = encode_host_card(card);
  CHECK(decode_host_card(file, "c") == card);
  for (std::size_t size = 0; size < file.size(); ++size) {
    CHECK_THROWS_AS(decode_host_card(file.substr(0, size), "c"), DataError);
  }
  CHECK_THROWS_AS(decode_host_card(encode_host_card({std::string(300, 'x'), 1, 2, 3}), "c"),
                  DataError);
}

TEST_CASE("each host leaves one card, the newest") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  HostCard card = this_host();
  CHECK_FALSE(card.host.empty());
  CHECK(card.booted_s <= card.seen_s);
  publish_host_card(stage, card);
  card.seen_s += 60;
  publish_host_card(stage, card);
  publish_host_card(stage, {"a first one", 1, 2, 3});
  stage.publish(HostName{7}, "damaged");
  const std::vector<HostCard> cards = read_host_cards(stage);
  REQUIRE(cards.size() == 2);
  CHECK(cards[0].host == "a first one");
  CHECK(cards[1] == card);
}

TEST_CASE("two hosts of one name are told from one that was started again") {
  const HostCard before{"pc", 1, 100, 500};
  const HostCard after{"pc", 2, 600, 900};   // the same, rebooted
  const HostCard other{"pc", 3, 200, 1000};  // up while the first was seen
  const HostCard elsewhere{"lab", 4, 100, 900};
  CHECK(names_in_double_use({}).empty());
  CHECK(names_in_double_use(std::vector{before, after, elsewhere}).empty());
  CHECK(names_in_double_use(std::vector{before, before}).empty());
  CHECK(names_in_double_use(std::vector{before, other}) == Names{"pc"});
  CHECK(names_in_double_use(std::vector{elsewhere, before, after, other}) == Names{"pc"});
}
