// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace meshfarm {

/// Lets this many threads read, or compute, concurrently, in order of arrival.
class TurnGate {
 public:
  explicit TurnGate(std::uint32_t places) : free_(places) {}
  TurnGate(const TurnGate&) = delete;
  TurnGate& operator=(const TurnGate&) = delete;

  /// Waits for a place. False, taking none, once `given_up` is set (see look_up()).
  bool enter(const std::atomic<bool>& given_up);
  void leave();
  /// Makes waiting threads check their `given_up`.
  void look_up();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint32_t free_;
  std::uint64_t next_ticket_ = 0;
  std::uint64_t served_ = 0;
};

/// The two gates shared by all slots of a worker.
struct WorkerGates {
  explicit WorkerGates(std::uint32_t threads) : reading(threads), computing(threads) {}
  TurnGate reading;  // for jobs that read much; see k_much_input
  TurnGate computing;
};

}  // namespace meshfarm
