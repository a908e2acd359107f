// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/signal_wait.hpp"

#include <algorithm>
#include <array>
#include <ctime>

namespace meshfarm {
namespace {

constexpr std::array k_ends = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};

}  // namespace

SignalWait::SignalWait() {
  ::sigemptyset(&kept_);
  for (const int signal : k_ends) ::sigaddset(&kept_, signal);
  for (const int signal : {SIGTSTP, SIGCONT, SIGWINCH}) ::sigaddset(&kept_, signal);
  ::pthread_sigmask(SIG_BLOCK, &kept_, &before_);
}

SignalWait::~SignalWait() {
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

std::optional<int> SignalWait::next(std::chrono::milliseconds within) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(within);
  const std::chrono::nanoseconds rest = within - seconds;
  const timespec time{seconds.count(), rest.count()};
  const int signal = ::sigtimedwait(&kept_, nullptr, &time);
  return signal > 0 ? std::optional(signal) : std::nullopt;
}

void SignalWait::stop() const {
  sigset_t stopping{};
  ::sigemptyset(&stopping);
  ::sigaddset(&stopping, SIGTSTP);
  ::raise(SIGTSTP);
  ::pthread_sigmask(SIG_UNBLOCK, &stopping, nullptr);  // the process stops here
  ::pthread_sigmask(SIG_BLOCK, &stopping, nullptr);
}

bool SignalWait::ends(int signal) {
  return std::find(k_ends.begin(), k_ends.end(), signal) != k_ends.end();
}

}  // namespace meshfarm
