// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "meshfarm_kernel.hpp"

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"meshfarm kernel", MESHFARM_VERSION, simplify_by_kernel});
}
