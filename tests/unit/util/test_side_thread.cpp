// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <doctest/doctest.h>

#include <meshfarm/util/side_thread.hpp>

using namespace meshfarm;
using namespace std::chrono_literals;

namespace {

struct Counter : SideThread::Signals {
  std::atomic<int> ends = 0;
  std::atomic<bool> held_up = false;

  void run() {
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return end; });
    }
    while (held_up) std::this_thread::sleep_for(1ms);
    ++ends;
  }
};

}  // namespace

TEST_CASE("a side thread ends with its owner") {
  const auto counter = std::make_shared<Counter>();
  {
    const SideThread thread(
        counter, [counter] { counter->run(); }, 1min);
  }
  CHECK(counter->ends == 1);
  CHECK(counter->ended);
}

TEST_CASE("a side thread that is held up is left behind, and keeps what it uses") {
  auto counter = std::make_shared<Counter>();
  const std::weak_ptr<Counter> watched = counter;
  counter->held_up = true;
  {
    const SideThread thread(
        counter, [counter] { counter->run(); }, 10ms);
  }
  CHECK(counter->ends == 0);
  counter->held_up = false;
  counter.reset();
  for (int i = 0; i < 2000 && !watched.expired(); ++i) std::this_thread::sleep_for(5ms);
  CHECK(watched.expired());
}
