// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/terminal_screen.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace meshfarm {
namespace {

/// Switches to the alternate screen and hides the cursor; and back (xterm's codes, widely
/// supported).
constexpr std::string_view k_enter = "\x1b[?1049h\x1b[?25l\x1b[H\x1b[2J";
constexpr std::string_view k_leave = "\x1b[?25h\x1b[?1049l";

std::string_view word_of(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

void write_out(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written <= 0) return;  // the terminal is gone; a signal reports it
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// A background process that accesses the terminal is stopped.
bool is_in_front(int fd) {
  return ::tcgetpgrp(fd) == ::getpgrp();
}

}  // namespace

bool TerminalScreen::is_there() {
  const std::string_view kind = word_of("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && !kind.empty() && kind != "dumb";
}

void TerminalScreen::enter() {
  if (is_on_ || !is_in_front(STDOUT_FILENO)) return;
  is_on_ = true;
  write_out(k_enter);
  has_keys_ = is_in_front(STDIN_FILENO) && ::tcgetattr(STDIN_FILENO, &before_) == 0;
  if (!has_keys_) return;
  termios quiet = before_;  // no echo, and keys are available at once
  quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO | ICANON);
  quiet.c_cc[VMIN] = 0;
  quiet.c_cc[VTIME] = 0;
  has_keys_ = ::tcsetattr(STDIN_FILENO, TCSADRAIN, &quiet) == 0;
}

void TerminalScreen::leave() {
  if (!is_on_) return;
  is_on_ = false;
  write_out(k_leave);
  if (has_keys_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

void TerminalScreen::show(const std::string& frame) const {
  if (is_on_ && is_in_front(STDOUT_FILENO)) write_out(frame);
}

bool TerminalScreen::quit_was_pressed() const {
  if (!is_on_ || !has_keys_ || !is_in_front(STDIN_FILENO)) return false;
  std::array<char, 64> keys{};
  const ssize_t count = ::read(STDIN_FILENO, keys.data(), keys.size());
  const auto end = keys.begin() + std::max<ssize_t>(count, 0);
  return std::any_of(keys.begin(), end, [](char key) { return key == 'q' || key == 'Q'; });
}

ScreenSize TerminalScreen::size() const {
  winsize found{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &found) != 0 || found.ws_col == 0 || found.ws_row == 0) {
    return {};
  }
  return {found.ws_col, found.ws_row};
}

Letters TerminalScreen::letters() {
  for (const char* const name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    std::string value(word_of(name));
    if (value.empty()) continue;
    std::transform(value.begin(), value.end(), value.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool is_utf8 =
        value.find("utf-8") != std::string::npos || value.find("utf8") != std::string::npos;
    return is_utf8 ? Letters::unicode : Letters::ascii;
  }
  return Letters::ascii;
}

}  // namespace meshfarm
