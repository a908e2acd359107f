// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>

#include <unistd.h>

#include <meshfarm/report/progress.hpp>

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_terminal_period{100};
constexpr std::chrono::milliseconds k_plain_period{3000};

std::string fixed(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

void write_stderr(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressStyle progress_style_of_stderr() {
  return ::isatty(STDERR_FILENO) == 1 ? ProgressStyle::terminal : ProgressStyle::plain;
}

std::string with_unit(double value) {
  if (value >= 999.5e6) return fixed(value / 1e9, 1) + " G";
  if (value >= 999.5e3) return fixed(value / 1e6, 1) + " M";
  if (value >= 999.5) return fixed(value / 1e3, 0) + " k";
  return fixed(value, 0) + " ";
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) {
    return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  }
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

std::string ProgressPrinter::line(const ProgressState& state, Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - phase_start_).count();
  std::string text = std::string(state.phase) + ": " + fixed(state.done * 100, 0) + " %";
  if (state.triangles > 0 && seconds > 0) {
    text += ", " + with_unit(static_cast<double>(state.triangles) / seconds) + "triangles/s";
  }
  if (state.done > 0.02 && state.done < 1 && seconds > 1) {
    text += ", " + duration_text(seconds * (1 - state.done) / state.done) + " left";
  }
  return text;
}

void ProgressPrinter::show(const ProgressState& state, Clock::time_point now) {
  if (style_ == ProgressStyle::none) return;
  const std::string_view kind = state.phase.substr(0, state.phase.find(','));
  if (kind != phase_kind_) {
    phase_kind_ = kind;
    phase_start_ = now;
    if (style_ == ProgressStyle::plain) last_shown_ = now;
  }
  const auto period = style_ == ProgressStyle::terminal ? k_terminal_period : k_plain_period;
  if (now - last_shown_ < period) return;
  last_shown_ = now;
  if (style_ == ProgressStyle::terminal) {
    write_stderr("\r\033[K" + line(state, now));
    line_open_ = true;
  } else {
    write_stderr(line(state, now) + "\n");
  }
}

void ProgressPrinter::end() {
  if (line_open_) write_stderr("\r\033[K");
  line_open_ = false;
}

}  // namespace meshfarm
