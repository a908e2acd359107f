// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <csignal>
#include <optional>

namespace meshfarm {

/// Keeps signals that end or stop a process, or tell of its terminal, until they are asked for.
/// Threads that start while this stands do not get them either.
class SignalWait {
 public:
  SignalWait();
  ~SignalWait();
  SignalWait(const SignalWait&) = delete;
  SignalWait& operator=(const SignalWait&) = delete;

  /// The next one; nothing if none comes in time.
  std::optional<int> next(std::chrono::milliseconds within) const;
  /// Stops this process as SIGTSTP does; returns when it is to go on.
  void stop() const;

  static bool ends(int signal);

 private:
  sigset_t kept_{};
  sigset_t before_{};
};

}  // namespace meshfarm
