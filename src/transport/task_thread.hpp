// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A thread that runs one task at a time beside an I/O loop; the loop polls fd() to learn when a
/// task ends. A task's results may be read once take_finished() returned true. A task must not
/// throw.
class TaskThread {
 public:
  TaskThread();
  /// Waits for the current task.
  ~TaskThread();
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  /// Call only when idle().
  void start(std::function<void()> task);
  /// True if no task is running, and none has ended that was not yet taken.
  bool idle() const { return idle_; }
  int fd() const { return event_.get(); }
  /// True once for each task that ended.
  bool take_finished();

 private:
  void run();

  Fd event_;
  bool idle_ = true;  // owned by the I/O loop
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;
  bool finished_ = false;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace meshfarm
