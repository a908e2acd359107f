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

/// A thread that its owner does not wait for long: where storage stalls, a call may take minutes.
/// It is left behind then, with all that it uses.
class SideThread {
 public:
  /// What the thread and its owner wait by.
  struct Signals {
    std::mutex mutex;
    std::condition_variable changed;
    bool end = false;    // it is to end
    bool ended = false;  // it did: set here
  };

  /// `work` keeps what it uses, and returns soon after signals->end is set if nothing holds it up.
  SideThread(std::shared_ptr<Signals> signals, std::function<void()> work,
             std::chrono::milliseconds last_wait);
  /// Waits for the thread's end, but no longer than that.
  ~SideThread();
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

 private:
  std::shared_ptr<Signals> signals_;
  std::chrono::milliseconds last_wait_;
  std::thread thread_;
};

}  // namespace meshfarm
