// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// One thread that does one task at a time beside an I/O loop, which polls fd() to hear of the end.
/// What a task wrote may be read once take_finished() has said so. A task must not throw.
class TaskThread {
 public:
  TaskThread();
  /// Waits for the task in work.
  ~TaskThread();
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  /// Only when idle().
  void start(std::function<void()> task);
  /// No task is in work, nor ended but not yet taken.
  bool idle() const { return idle_; }
  int fd() const { return event_.get(); }
  /// True once for each task that ended.
  bool take_finished();

 private:
  void run();

  Fd event_;
  bool idle_ = true;  // the I/O loop's own
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;
  bool finished_ = false;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace meshfarm
