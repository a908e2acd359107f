// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace meshfarm {

/// A thread that its owner never waits for long: with stalled storage a call may take minutes. The
/// thread is then left behind, with everything that it uses.
class SideThread {
 public:
  /// Synchronises the thread and its owner.
  struct Signals {
    std::mutex mutex;
    std::condition_variable changed;
    bool end = false;    // asks the thread to end
    bool ended = false;  // it has ended: set here
  };

  /// `work` must own what it uses, and return soon after signals->end is set unless it is blocked.
  SideThread(std::shared_ptr<Signals> signals, std::function<void()> work,
             std::chrono::milliseconds last_wait);
  /// Waits for the thread to end, for at most `last_wait`.
  ~SideThread();
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

 private:
  std::shared_ptr<Signals> signals_;
  std::chrono::milliseconds last_wait_;
  std::thread thread_;
};

}  // namespace meshfarm
