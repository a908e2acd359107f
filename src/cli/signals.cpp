// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/signals.hpp"

#include <csignal>

namespace meshfarm {
namespace {

// A signal handler can only access globals.
std::atomic<bool> g_stop{false};

extern "C" void on_signal(int) {
  g_stop = true;
}

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  action.sa_flags = 0;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGHUP, &action, nullptr);
  return g_stop;
}

}  // namespace meshfarm
