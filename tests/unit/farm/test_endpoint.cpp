// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/seeds.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

const Endpoint k_endpoint{3, 7, "tcp://10.0.0.1:5555", "host", 42, "key"};

TEST_CASE("an endpoint comes back as it was, and damaged not at all") {
  const std::string file = encode_endpoint(k_endpoint);
  CHECK(decode_endpoint(file, "e") == k_endpoint);
  for (std::size_t size = 0; size < file.size(); ++size) {
    CHECK_THROWS_AS(decode_endpoint(file.substr(0, size), "e"), DataError);
  }
  for (std::size_t i = 0; i < file.size(); ++i) {
    std::string changed = file;
    changed[i] = static_cast<char>(changed[i] ^ 4);
    CHECK_THROWS_AS(decode_endpoint(changed, "e"), DataError);
  }
}

TEST_CASE("the fuzzer begins from endpoints of this version") {
  const std::string file = encode_endpoint(k_endpoint);
  Endpoint over = k_endpoint;
  over.address.clear();
  over.done = true;
  test::check_seed("endpoint", "file", file);
  test::check_seed("endpoint", "over", encode_endpoint(over));
  constexpr std::size_t k_checksum_bytes = 8;
  test::check_seed(
      "endpoint", "payload",
      file.substr(k_seal_head_bytes, file.size() - k_seal_head_bytes - k_checksum_bytes));
}

TEST_CASE("each publisher gets an epoch of its own, above all that there are") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  CHECK(publish_endpoint(stage, k_endpoint, "a").epoch == 1);
  CHECK(publish_endpoint(stage, k_endpoint, "b").epoch == 2);
  stage.publish(EndpointName{9}, "damaged");
  CHECK(publish_endpoint(stage, k_endpoint, "c").epoch == 10);

  EndpointList list;
  const std::vector<Endpoint> seen = list.look(stage);
  REQUIRE(seen.size() == 3);
  CHECK(seen[2].epoch == 10);
  CHECK(seen[2].address == k_endpoint.address);
  publish_endpoint(stage, k_endpoint, "d");
  CHECK(list.look(stage).back().epoch == 11);
}

TEST_CASE("of many who publish at the same time each has an epoch of its own") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  constexpr std::uint32_t k_publishers = 8;
  constexpr std::uint32_t k_each = 10;
  std::vector<std::vector<std::uint32_t>> epochs(k_publishers);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t i = 0; i < k_publishers; ++i) {
      threads.emplace_back([&, i] {
        for (std::uint32_t n = 0; n < k_each; ++n) {
          Endpoint mine = k_endpoint;
          mine.pid = i;
          epochs[i].push_back(publish_endpoint(stage, mine, "p" + std::to_string(i)).epoch);
        }
      });
    }
  }
  std::set<std::uint32_t> all;
  for (const auto& each : epochs) all.insert(each.begin(), each.end());
  CHECK(all.size() == k_publishers * k_each);
}

TEST_CASE("an endpoint under another number than its own is left out") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  stage.publish(EndpointName{5}, encode_endpoint(k_endpoint));
  EndpointList list;
  CHECK(list.look(stage).empty());
}

}  // namespace
}  // namespace meshfarm
