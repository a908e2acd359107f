// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/task_thread.hpp"

#include <cassert>
#include <cstdint>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

TaskThread::TaskThread() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) throw_errno("cannot make", "an eventfd");
  thread_ = std::thread([this] { run(); });
}

TaskThread::~TaskThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void TaskThread::start(std::function<void()> task) {
  assert(idle_);
  idle_ = false;
  {
    const std::lock_guard lock(mutex_);
    task_ = std::move(task);
  }
  changed_.notify_one();
}

bool TaskThread::take_finished() {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(finished_, false)) return false;
  std::uint64_t count = 0;
  // Only resets the event; finished_ is the state that counts.
  [[maybe_unused]] const auto ignored = ::read(event_.get(), &count, sizeof count);
  idle_ = true;
  return true;
}

void TaskThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || task_; });
    if (!task_) return;
    const std::function<void()> task = std::exchange(task_, {});
    lock.unlock();
    task();
    lock.lock();
    finished_ = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto ignored = ::write(event_.get(), &one, sizeof one);
  }
}

}  // namespace meshfarm
