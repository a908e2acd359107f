// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// meshfarm without the input's colours: shows what they cost in time and error.
#include <utility>

#include "meshfarm_kernel.hpp"

namespace meshfarm::bench {
namespace {

Mesh simplify_shape(Task task, Stopwatch& watch) {
  task.mesh.appearances = {};
  return simplify_by_kernel(std::move(task), watch);
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"meshfarm kernel, shape alone,", MESHFARM_VERSION, simplify_shape});
}
