// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <sys/time.h>

#include "transport/sockets.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("signals do not keep messages from being sent") {
  struct sigaction ignore {};
  ignore.sa_handler = [](int) {};  // without SA_RESTART: calls are interrupted
  struct sigaction before {};
  ::sigaction(SIGALRM, &ignore, &before);
  zmq::context_t context = make_context();
  zmq::socket_t server = make_control_server(context, {});
  const std::string address = bind_within(server, "127.0.0.1", {});
  zmq::socket_t client = make_control_client(context, {}, 7);
  client.connect(address);
  send(client, Complete{1});  // libzmq's threads exist from here on; the kernel can start none
  const itimerval often{{0, 50}, {0, 50}};  // while signals arrive this fast
  ::setitimer(ITIMER_REAL, &often, nullptr);
  const auto begin = std::chrono::steady_clock::now();
  CHECK_NOTHROW([&] {
    for (int i = 0; i < 100'000; ++i) {
      if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(10)) break;
      send(client, Complete{1});
      if (const auto received = receive(server)) send(server, received->peer, Complete{2});
      receive(client);
    }
  }());
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
}

TEST_CASE("a process that is behind with its messages outlives whoever sent them") {
  // With libzmq's own heartbeats an assertion in libzmq failed here, and ended the process.
  zmq::context_t here{1};
  zmq::socket_t results = make_results_server(here, {});
  const std::string address = bind_within(results, "127.0.0.1", {});
  {
    zmq::context_t there{1};
    zmq::socket_t push = make_results_client(there, {});
    push.set(zmq::sockopt::linger, 0);
    push.connect(address);
    for (std::uint64_t i = 0; i < 100'000; ++i) send(push, Ready{1, i});
    std::vector<zmq::pollitem_t> items = {{results.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::seconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }  // gone, with most messages not taken yet
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  std::uint64_t next = 0;
  while (auto received = receive(results)) {
    REQUIRE(received->message);
    CHECK(std::get<Ready>(*received->message).accepted == next++);
  }
  CHECK(next >= 500);
}

}  // namespace
}  // namespace meshfarm::test
