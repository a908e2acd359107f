// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshfarm {

enum class ProgressStyle {
  none,      // --quiet
  plain,     // a line every few seconds, for logs
  terminal,  // one line, rewritten
};

/// terminal if stderr is one, else plain.
ProgressStyle progress_style_of_stderr();

/// A running activity: how far it is, its rate, and its estimated end.
struct ProgressState {
  std::string_view phase;       // "cut: triangles", "farm: 12 of 28 jobs"
  double done = 0;              // 0 .. 1
  std::uint64_t triangles = 0;  // done so far, for the rate; 0: no rate
};

/// "1.2 M", "345 k", "12"
std::string with_unit(double value);
/// "4 s", "3 min 20 s", "2 h 5 min"
std::string duration_text(double seconds);

/// Writes progress to stderr, as often as its style allows. Pure apart from the write:
/// line() is what would be written.
class ProgressPrinter {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressPrinter(ProgressStyle style) : style_(style) {}
  ~ProgressPrinter() { end(); }
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void show(const ProgressState& state, Clock::time_point now = Clock::now());
  /// Frees the terminal's line for further output.
  void end();

  std::string line(const ProgressState& state, Clock::time_point now) const;

 private:
  ProgressStyle style_;
  std::string phase_kind_;  // the phase up to its colon: rate and ETA restart when it changes
  Clock::time_point phase_start_{};
  Clock::time_point last_shown_{};
  bool line_open_ = false;
};

}  // namespace meshfarm
