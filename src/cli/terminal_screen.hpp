// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <termios.h>

#include <meshfarm/report/status_screen.hpp>

namespace meshfarm {

/// The terminal of stdout as a separate screen that preserves the previous content.
class TerminalScreen {
 public:
  /// Whether stdout is a suitable terminal.
  static bool is_there();

  TerminalScreen() { enter(); }
  ~TerminalScreen() { leave(); }
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  /// Starts, or starts again after leave().
  void enter();
  /// Restores the terminal.
  void leave();
  /// Writes the frame at once. Does nothing while another process has the terminal.
  void show(const std::string& frame) const;
  /// Whether q was pressed since the last call.
  bool quit_was_pressed() const;

  ScreenSize size() const;
  /// What the terminal can show according to the locale.
  static Letters letters();

 private:
  bool is_on_ = false;
  bool has_keys_ = false;
  termios before_{};
};

}  // namespace meshfarm
