// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/cli/command_line.hpp>

int main(int argc, char** argv) {
  return meshfarm::run_command_line(argc, argv);
}
