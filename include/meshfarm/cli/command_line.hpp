// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

namespace meshfarm {

/// Runs the program: finds the command, executes it, and returns the exit code: 0 done, 1 failed
/// (bad input, I/O), 2 wrong usage, 3 incomplete but resumable. Every error is one line on stderr.
int run_command_line(int argc, const char* const* argv);

}  // namespace meshfarm
