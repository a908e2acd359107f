// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

/// How patient a reader is with a file that it was told of but does not see whole (NFS).
struct ReadPatience {
  int attempts = 5;        // at an existing file that does not match; 1: no waiting at all
  int first_wait_ms = 50;  // doubles each time, up to five seconds
  /// How long a file may be missing: 30 to 60 s were observed on NFS.
  std::chrono::milliseconds missing{90'000};
  /// How long storage may fail.
  std::chrono::milliseconds failing{90'000};
  /// Called with the number of bytes read, and with 0 while there is still patience.
  std::function<void(std::uint64_t bytes)> moved = {};
};

/// For files that are known to exist: waits only for failing storage.
ReadPatience patience_with_storage();
/// Ends the patience with the kind of failure that the error reports, which was waited for in vain:
/// by the clock, the next file has had its time, too.
void spend(ReadPatience& patience, const Error& error);

/// One reader's waiting, by the clock, from construction on.
class Waiting {
 public:
  explicit Waiting(const ReadPatience& patience);
  /// Whether the error may pass and patience remains. If so, waits before it returns.
  bool again(const IoError& error);
  /// Waits, longer each time.
  void pause();
  std::chrono::milliseconds waited() const;

 private:
  const ReadPatience& patience_;
  std::chrono::steady_clock::time_point begin_;
  int wait_ms_;
};

/// Repeats `work` as long as it throws errors that may pass.
template <class Work>
auto outlast(const ReadPatience& patience, const Work& work) {
  for (Waiting waiting(patience);;) {
    try {
      return work();
    } catch (const IoError& error) {
      if (!waiting.again(error)) throw;
    }
  }
}

}  // namespace meshfarm
