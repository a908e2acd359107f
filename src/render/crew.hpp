// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace meshfarm {

/// Threads that do the work that one thread hands out. That thread helps when too much work is
/// waiting, so that only a few pieces of work are in memory.
class Crew {
 public:
  /// The number of threads includes the one that hands out (0: one per core).
  explicit Crew(unsigned threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  unsigned size() const { return static_cast<unsigned>(helpers_.size()) + 1; }
  void give(std::function<void()> work);
  /// Waits until everything is done. Rethrows the exception of the first failed piece of work.
  void wait();

  /// On destruction, also by an exception, waits until no thread works any more. Must be declared
  /// after everything that the work refers to.
  class Shift {
   public:
    explicit Shift(Crew& crew) : crew_(crew) {}
    ~Shift() { crew_.stop(); }
    Shift(const Shift&) = delete;
    Shift& operator=(const Shift&) = delete;

   private:
    Crew& crew_;
  };

 private:
  void stop();
  void serve();
  void run(const std::function<void()>& work);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t running_ = 0;
  bool is_over_ = false;
  std::exception_ptr failure_;
  std::vector<std::jthread> helpers_;
};

}  // namespace meshfarm
