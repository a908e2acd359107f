// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <termios.h>

#include <meshfarm/report/status_screen.hpp>

namespace meshfarm {

/// The terminal of stdout as a screen of its own, that leaves what was there before as it was.
class TerminalScreen {
 public:
  /// Whether stdout is a terminal that can be one.
  static bool is_there();

  TerminalScreen() { enter(); }
  ~TerminalScreen() { leave(); }
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  /// Begins, or begins again after leave().
  void enter();
  /// Gives the terminal back.
  void leave();
  /// In one write. Nothing happens while another has the terminal.
  void show(const std::string& frame) const;
  /// Whether somebody pressed q since the last time.
  bool quit_was_pressed() const;

  ScreenSize size() const;
  /// What the locale says that the terminal can show.
  static Letters letters();

 private:
  bool is_on_ = false;
  bool has_keys_ = false;
  termios before_{};
};

}  // namespace meshfarm
