// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/util/apart.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

constexpr std::uint64_t k_most_bytes = std::uint64_t{1} << 28;

ApartEnd end_of(const std::function<void(const SendBytes&)>& work) {
  return run_apart(
      work, [](const std::string&) {}, k_most_bytes);
}

}  // namespace

TEST_CASE("what is sent by a process apart comes in order and whole") {
  const std::vector<std::string> sent{"one", "", std::string(5'000'000, 'x'), "end"};
  std::vector<std::string> taken;
  const ApartEnd end = run_apart(
      [&](const SendBytes& send) {
        for (const std::string& bytes : sent) send(bytes);
      },
      [&](std::string bytes) { taken.push_back(std::move(bytes)); }, k_most_bytes);
  CHECK(end == ApartEnd::done);
  CHECK(taken == sent);
}

TEST_CASE("an error in a process apart is thrown by who waits for it") {
  CHECK_THROWS_WITH_AS(end_of([](const SendBytes&) { throw DataError("m.glb: is bad"); }),
                       "m.glb: is bad", DataError);
}

TEST_CASE("a process apart that crashes, or stops early, takes nothing with it") {
  for (const int number : {SIGSEGV, SIGABRT, SIGKILL}) {
    CHECK(end_of([number](const SendBytes& send) {
            send("some");
            ::raise(number);
          }) == ApartEnd::died);
  }
  CHECK(end_of([](const SendBytes&) { std::_Exit(0); }) == ApartEnd::died);
  CHECK(end_of([](const SendBytes&) { throw 1; }) == ApartEnd::died);
}

TEST_CASE("a process apart has no more memory than it may take") {
  std::size_t taken = 0;
  const auto want = [&](std::size_t bytes) {
    return run_apart(
        [bytes](const SendBytes& send) { send(std::string(bytes, 'x').substr(bytes - 9)); },
        [&](const std::string& got) { taken += got.size(); }, k_most_bytes);
  };
  CHECK(want(k_most_bytes / 2) == ApartEnd::done);
  CHECK(taken == 9);
  CHECK(want(2 * k_most_bytes) != ApartEnd::done);
  CHECK(taken == 9);
}

TEST_CASE("who takes may throw while a process apart still sends") {
  CHECK_THROWS_AS(run_apart(
                      [](const SendBytes& send) {
                        for (;;) send(std::string(100'000, 'x'));
                      },
                      [](const std::string&) { throw DataError("enough"); }, k_most_bytes),
                  DataError);
}
