// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <meshfarm/util/file.hpp>

#include "transport/gatekeeper.hpp"
#include "transport/sockets.hpp"

namespace meshfarm::test {
namespace {

const Message k_word = Ready{1, 2};

/// A listening process: context, gatekeeper and a socket for results.
struct Server {
  explicit Server(const Keys& with) : keys(with), results(make_results_server(context, keys)) {
    gate.watch(results);
    address = bind_within(results, "127.0.0.1", {});
  }
  /// Whether a message arrives within `patience`.
  bool hears(std::chrono::milliseconds patience) {
    std::vector<zmq::pollitem_t> items = {{results.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, patience);
    return receive(results).has_value();
  }
  std::uint64_t refused() const {
    const Refusals refusals = gate.refused();
    return refusals.stated + refusals.left_off;
  }
  bool refuses(std::uint64_t count) const {
    for (int i = 0; i < 500 && refused() < count; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return refused() >= count;
  }

  Keys keys;
  zmq::context_t context{1};
  Gatekeeper gate{context, keys};
  zmq::socket_t results;
  std::string address;
};

/// Sends one message with the given keys.
struct Client {
  Client(const Server& server, const Keys& keys) : push(make_results_client(context, keys)) {
    push.set(zmq::sockopt::linger, 0);
    push.connect(server.address);
    send(push, k_word);
  }
  zmq::context_t context{1};
  zmq::socket_t push;
};

/// Connects `times` times, and leaves without a message each time.
void come_and_go(const Server& server, int times) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(
      static_cast<std::uint16_t>(std::stoi(server.address.substr(server.address.rfind(':') + 1))));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (int i = 0; i < times; ++i) {
    const Fd fd(::socket(AF_INET, SOCK_STREAM, 0));
    REQUIRE(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
  }
}

constexpr std::chrono::milliseconds k_soon{10'000};
constexpr std::chrono::milliseconds k_never{300};

TEST_CASE("who has the keys comes in") {
  Server server(make_run_keys());
  const Client client(server, server.keys);
  CHECK(server.hears(k_soon));
  CHECK(server.refused() == 0);
}

TEST_CASE("wrong keys and no keys do not, and are counted") {
  Server server(make_run_keys());
  Keys theirs = make_run_keys();
  SUBCASE("a client key of another run") {
    theirs->server_public = server.keys->server_public;
  }
  SUBCASE("another server expected") {
    theirs = server.keys;
    theirs->server_public = make_run_keys().server_public;
  }
  SUBCASE("none at all") {
    theirs.reset();
  }
  const Client client(server, theirs);
  CHECK_FALSE(server.hears(k_never));
  CHECK(server.refuses(1));
  const Client good(server, server.keys);
  CHECK(server.hears(k_soon));
}

TEST_CASE("without keys everybody comes in, but for who does not speak the protocol") {
  Server server(std::nullopt);
  const Client client(server, std::nullopt);
  CHECK(server.hears(k_soon));
  const Client curve(server, make_run_keys());
  CHECK(server.refuses(1));
}

TEST_CASE("a few that leave while they connect are no strangers, many are") {
  const Server server(make_run_keys());
  come_and_go(server, 10);
  CHECK(server.refuses(10));
  CHECK(server.gate.refused().strangers() == 0);
  come_and_go(server, 30);
  CHECK(server.refuses(40));
  CHECK(server.gate.refused().strangers() == 40);
}

TEST_CASE("who says something wrong is a stranger at once") {
  CHECK(Refusals{1, 0}.strangers() == 1);
  CHECK(Refusals{2, 16}.strangers() == 2);
  CHECK(Refusals{2, 17}.strangers() == 19);
}

TEST_CASE("sockets may come and go") {
  zmq::context_t context(1);
  const Keys keys = make_run_keys();
  Gatekeeper gate(context, keys);
  for (int i = 0; i < 50; ++i) {
    zmq::socket_t lane = make_lane_server(context, keys);
    gate.watch(lane);
    bind_within(lane, "127.0.0.1", {});
  }
  CHECK(gate.refused().stated == 0);
  CHECK(gate.refused().left_off == 0);
}

}  // namespace
}  // namespace meshfarm::test
