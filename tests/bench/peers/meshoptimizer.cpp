// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>
#include <vector>

#include <meshoptimizer.h>

#include "meshoptimizer_version.hpp"
#include "peer.hpp"

namespace meshfarm::bench {
namespace {

struct FloatMesh {
  std::vector<float> positions;  // x y z
  std::vector<unsigned> indices;
};

FloatMesh to_floats(const Mesh& mesh) {
  FloatMesh out;
  out.positions.reserve(3 * mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) out.positions.push_back(static_cast<float>(p[axis]));
  }
  out.indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

Mesh to_mesh(FloatMesh& in) {
  const std::size_t kept =
      meshopt_optimizeVertexFetch(in.positions.data(), in.indices.data(), in.indices.size(),
                                  in.positions.data(), in.positions.size() / 3, 3 * sizeof(float));
  Mesh out;
  for (std::size_t v = 0; v < kept; ++v) {
    const float* p = &in.positions[3 * v];
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (std::size_t i = 0; i < in.indices.size(); i += 3) {
    out.triangles.push_back({in.indices[i], in.indices[i + 1], in.indices[i + 2]});
  }
  return out;
}

Mesh simplify(Task task, Stopwatch& watch) {
  FloatMesh mesh = to_floats(task.mesh);
  task.mesh = {};
  std::vector<unsigned> left(mesh.indices.size());
  const float any_error = std::numeric_limits<float>::max();
  watch.start();
  const std::size_t count = meshopt_simplify(
      left.data(), mesh.indices.data(), mesh.indices.size(), mesh.positions.data(),
      mesh.positions.size() / 3, 3 * sizeof(float), 3 * task.target, any_error, 0, nullptr);
  watch.stop();
  left.resize(count);
  mesh.indices.swap(left);
  return to_mesh(mesh);
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"meshoptimizer", meshoptimizer_version(), simplify});
}
