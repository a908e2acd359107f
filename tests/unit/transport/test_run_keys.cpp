// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/temp_folder.hpp"
#include "transport/run_keys.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

struct KeyStage {
  TempFolder folder;
  Stage stage = Stage::create(folder / "stage");
  Endpoint endpoint{1, 7, "tcp://10.0.0.1:5555", "host", 42, {}};
};

TEST_CASE("keys come back as they were, and damaged not at all") {
  const RunKeys keys = make_run_keys();
  const std::string file = encode_keys(keys);
  CHECK(decode_keys(file, "k") == keys);
  for (std::size_t size = 0; size < file.size(); ++size) {
    CHECK_THROWS_AS(decode_keys(file.substr(0, size), "k"), DataError);
  }
  RunKeys mixed = keys;
  mixed.client_secret = make_run_keys().client_secret;
  CHECK_THROWS_AS(decode_keys(encode_keys(mixed), "k"), DataError);
  RunKeys shorter = keys;
  shorter.server_public.pop_back();
  CHECK_THROWS_AS(decode_keys(encode_keys(shorter), "k"), DataError);
  RunKeys garbled = keys;
  garbled.client_public.assign(40, '\x7f');
  CHECK_THROWS_AS(decode_keys(encode_keys(garbled), "k"), DataError);
}

TEST_CASE("all processes of a run have the same keys, other runs have others") {
  const KeyStage on;
  const Keys first = keys_to_serve(on.stage, 7, {});
  REQUIRE(first);
  CHECK(keys_to_serve(on.stage, 7, {}) == first);
  CHECK(keys_to_serve(on.stage, 8, {}) != first);
  Endpoint endpoint = on.endpoint;
  endpoint.server_key = first->server_public;
  CHECK(keys_to_connect(on.stage, endpoint, {}) == first);
  const fs::path path = on.stage.path(KeysName{7});
  CHECK(fs::status(path).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("of many that come first at the same time one makes the keys, all have the same") {
  const KeyStage on;
  std::vector<Keys> found(8);
  {
    std::vector<std::jthread> threads;
    for (Keys& keys : found) {
      threads.emplace_back([&] { keys = keys_to_serve(on.stage, 7, {}); });
    }
  }
  for (const Keys& keys : found) {
    REQUIRE(keys);
    CHECK(keys == found.front());
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(on.stage.root() / "control")) {
    ++files;
  }
  CHECK(files == 1);
}

TEST_CASE("keys that others can read are refused, and those of a key file are taken") {
  const KeyStage on;
  const SecurityOptions elsewhere{.key_file = on.folder / "mine.keys"};
  const Keys keys = keys_to_serve(on.stage, 7, elsewhere);
  REQUIRE(keys);
  CHECK_FALSE(fs::exists(on.stage.path(KeysName{7})));
  CHECK(keys_to_serve(on.stage, 8, elsewhere) == keys);
  Endpoint endpoint = on.endpoint;
  endpoint.server_key = keys->server_public;
  CHECK(keys_to_connect(on.stage, endpoint, elsewhere) == keys);
  fs::permissions(elsewhere.key_file, fs::perms::group_read, fs::perm_options::add);
  CHECK_THROWS_WITH_AS(keys_to_serve(on.stage, 7, elsewhere),
                       doctest::Contains("others may read these keys"), DataError);
}

TEST_CASE("who authenticates and who does not do not come together") {
  const KeyStage on;
  const SecurityOptions insecure{.authentication = Authentication::none, .key_file = {}};
  CHECK_FALSE(keys_to_serve(on.stage, 7, insecure));
  CHECK_FALSE(keys_to_connect(on.stage, on.endpoint, insecure));
  CHECK_THROWS_WITH_AS(keys_to_connect(on.stage, on.endpoint, {}),
                       doctest::Contains("authenticates nobody"), DataError);
  Endpoint endpoint = on.endpoint;
  endpoint.server_key = keys_to_serve(on.stage, 7, {})->server_public;
  CHECK_THROWS_WITH_AS(keys_to_connect(on.stage, endpoint, insecure),
                       doctest::Contains("without --insecure"), DataError);
  endpoint.server_key = make_run_keys().server_public;
  CHECK_THROWS_WITH_AS(keys_to_connect(on.stage, endpoint, {}), doctest::Contains("not the keys"),
                       DataError);
}

TEST_CASE("sockets without authentication stay on this host unless that is asked for") {
  for (const char* bind : {"127.0.0.1", "127.1.2.3", "localhost", "lo", "[::1]"}) {
    CAPTURE(bind);
    CHECK(is_loopback(bind));
  }
  for (const char* bind : {"0.0.0.0", "*", "10.0.0.1", "127.evil.example", "eth0", "::", ""}) {
    CAPTURE(bind);
    CHECK_FALSE(is_loopback(bind));
    SecurityOptions security{.authentication = Authentication::none, .key_file = {}};
    CHECK_THROWS_AS(check_exposure(security, bind), UsageError);
    security.insecure_exposure = Exposure::network;
    CHECK_NOTHROW(check_exposure(security, bind));
    CHECK_NOTHROW(check_exposure({}, bind));
  }
}

}  // namespace
}  // namespace meshfarm::test
