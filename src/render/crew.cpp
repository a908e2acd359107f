// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/crew.hpp"

#include <utility>

#include <meshfarm/util/control_groups.hpp>

namespace meshfarm {

Crew::Crew(unsigned threads) {
  if (threads == 0) threads = processors();
  for (unsigned i = 1; i < threads; ++i) helpers_.emplace_back([this] { serve(); });
}

Crew::~Crew() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
}

void Crew::give(std::function<void()> work) {
  {
    std::unique_lock lock(mutex_);
    if (waiting_.size() < helpers_.size()) {
      waiting_.push_back(std::move(work));
      lock.unlock();
      changed_.notify_all();
      return;
    }
  }
  run(work);
}

void Crew::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && running_ == 0; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Crew::stop() {
  std::unique_lock lock(mutex_);
  waiting_.clear();
  changed_.wait(lock, [this] { return running_ == 0; });
}

void Crew::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
    if (is_over_) return;
    const std::function<void()> work = std::move(waiting_.front());
    waiting_.pop_front();
    ++running_;
    lock.unlock();
    run(work);
    lock.lock();
    --running_;
    changed_.notify_all();
  }
}

void Crew::run(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

}  // namespace meshfarm
