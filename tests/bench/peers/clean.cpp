// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Not a peer: writes the clean mesh that all peers get, for peers that are not written in C++.
#include <utility>

#include "peer.hpp"

int main(int argc, char** argv) {
  using namespace meshfarm;
  return bench::run_peer(argc, argv,
                         {"clean", MESHFARM_VERSION, [](bench::Task task, bench::Stopwatch& watch) {
                            watch.start();
                            watch.stop();
                            return std::move(task.mesh);
                          }});
}
