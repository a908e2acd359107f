// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/turn_gate.hpp"

namespace meshfarm {

bool TurnGate::enter(const std::atomic<bool>& given_up) {
  std::unique_lock lock(mutex_);
  const std::uint64_t ticket = next_ticket_++;
  changed_.wait(lock, [&] { return served_ == ticket && (free_ > 0 || given_up); });
  ++served_;  // a thread that gave up has had its turn, too
  const bool entered = !given_up;
  if (entered) --free_;
  lock.unlock();
  changed_.notify_all();
  return entered;
}

void TurnGate::leave() {
  {
    const std::lock_guard lock(mutex_);
    ++free_;
  }
  changed_.notify_all();
}

void TurnGate::look_up() {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

}  // namespace meshfarm
