// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <csignal>
#include <optional>

namespace meshfarm {

/// Blocks signals that end or stop a process, or report changes of its terminal, until they are
/// queried. Threads started while this exists do not get them either.
class SignalWait {
 public:
  SignalWait();
  ~SignalWait();
  SignalWait(const SignalWait&) = delete;
  SignalWait& operator=(const SignalWait&) = delete;

  /// The next signal; nothing if none arrives in time.
  std::optional<int> next(std::chrono::milliseconds within) const;
  /// Stops this process like SIGTSTP; returns when it is continued.
  void stop() const;

  static bool ends(int signal);

 private:
  sigset_t kept_{};
  sigset_t before_{};
};

}  // namespace meshfarm
