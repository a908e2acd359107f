// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <httplib.h>

#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/transport/page_server.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm::test {
namespace {

std::optional<ServedPage> answer_of(const std::string& path) {
  if (path != "/a") return std::nullopt;
  return ServedPage{"text/plain", "A"};
}

TEST_CASE("pages are served to this host, and to who asks for it by its name") {
  const PageServer server(0, answer_of);
  httplib::Client client("127.0.0.1", server.port());
  const auto status = [&](const char* path, const char* host) {
    const auto got = client.Get(path, {{"Host", host}});
    return got ? got->status : 0;
  };
  CHECK(status("/a", "localhost:80") == 200);
  CHECK(status("/a", "127.0.0.1") == 200);
  CHECK(status("/a", "[::1]:80") == 200);
  CHECK(status("/a", "evil.example:80") == 403);
  CHECK(status("/a", "localhost.evil.example") == 403);
  CHECK(status("/b", "localhost") == 404);
  CHECK(client.Get("/a")->body == "A");
  CHECK(client.Get("/a")->has_header("Content-Security-Policy"));
  // Not reachable from the network.
  if (const auto address = network_address()) {
    httplib::Client far(*address, server.port());
    CHECK_FALSE(far.Get("/a"));
  }
}

TEST_CASE("a port that is taken is not shared") {
  const PageServer server(0, answer_of);
  CHECK_THROWS_AS(PageServer(server.port(), answer_of), IoError);
}

}  // namespace
}  // namespace meshfarm::test
