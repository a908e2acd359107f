// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/util/side_thread.hpp>

namespace meshfarm {

SideThread::SideThread(std::shared_ptr<Signals> signals, std::function<void()> work,
                       std::chrono::milliseconds last_wait)
    : signals_(std::move(signals)),
      last_wait_(last_wait),
      thread_([kept = signals_, work = std::move(work)] {
        work();
        const std::lock_guard lock(kept->mutex);
        kept->ended = true;
        kept->changed.notify_all();
      }) {}

SideThread::~SideThread() {
  std::unique_lock lock(signals_->mutex);
  signals_->end = true;
  signals_->changed.notify_all();
  const bool ended =
      signals_->changed.wait_for(lock, last_wait_, [this] { return signals_->ended; });
  lock.unlock();
  ended ? thread_.join() : thread_.detach();
}

}  // namespace meshfarm
