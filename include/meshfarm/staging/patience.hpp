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
  int attempts = 5;        // at a file that is there, but not as promised; 1: no waiting at all
  int first_wait_ms = 50;  // doubles each time, up to five seconds
  /// How long a file may be missing: NFS was seen to take 30 to 60 s.
  std::chrono::milliseconds missing{90'000};
  /// How long its storage may fail.
  std::chrono::milliseconds failing{90'000};
  /// Called with the bytes that came, and with none as long as there is still patience.
  std::function<void(std::uint64_t bytes)> moved = {};
};

/// For who knows that a file is there: only its storage's failures are waited for.
ReadPatience patience_with_storage();
/// What was waited for in vain, as the error says, is not waited for again: by the clock, the next
/// file has had its time, too.
void spend(ReadPatience& patience, const Error& error);

/// One reader's waiting, by the clock, from when it was made.
class Waiting {
 public:
  explicit Waiting(const ReadPatience& patience);
  /// Whether the error may pass and there is still patience with it. If so, a while has gone by.
  bool again(const IoError& error);
  /// Lets a while go by, longer each time.
  void pause();
  std::chrono::milliseconds waited() const;

 private:
  const ReadPatience& patience_;
  std::chrono::steady_clock::time_point begin_;
  int wait_ms_;
};

/// Does `work` again as long as it throws what may pass.
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
