// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The leanest whole run with meshoptimizer that we know: the file is mapped and scanned straight
// into its arrays, its own functions weld and compact, and the clock runs from open to close.
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <meshoptimizer.h>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

#include "meshoptimizer_version.hpp"
#include "peer.hpp"

namespace meshfarm::bench {
namespace {

constexpr std::size_t k_stride = 3 * sizeof(float);

std::vector<float> read_positions(MeshSource& source) {
  std::vector<float> positions;
  positions.reserve(3 * source.info().vertices);
  source.scan_vertices([&](std::span<const Vec3> batch) {
    for (const Vec3& p : batch) {
      for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
    }
  });
  return positions;
}

std::vector<unsigned> read_indices(MeshSource& source) {
  std::vector<unsigned> indices;
  indices.reserve(3 * source.info().faces);
  source.scan_triangles([&](std::span<const WideTriangle> batch) {
    for (const WideTriangle& t : batch) {
      for (const std::uint64_t vertex : t) indices.push_back(static_cast<unsigned>(vertex));
    }
  });
  return indices;
}

struct Arrays {
  std::vector<float> positions;  // x y z
  std::vector<unsigned> indices;
};

/// Merges vertices at the same point. (With a shadow index buffer, which leaves the twins in place,
/// meshopt_simplify takes them for seams.)
void weld(Arrays& mesh) {
  const std::size_t vertices = mesh.positions.size() / 3;
  std::vector<unsigned> remap(vertices);
  const std::size_t distinct =
      meshopt_generateVertexRemap(remap.data(), mesh.indices.data(), mesh.indices.size(),
                                  mesh.positions.data(), vertices, k_stride);
  meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                           remap.data());
  meshopt_remapVertexBuffer(mesh.positions.data(), mesh.positions.data(), vertices, k_stride,
                            remap.data());
  mesh.positions.resize(3 * distinct);
}

void drop_degenerate(std::vector<unsigned>& indices) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const unsigned a = indices[i];
    const unsigned b = indices[i + 1];
    const unsigned c = indices[i + 2];
    if (a == b || b == c || c == a) continue;
    indices[kept] = a;
    indices[kept + 1] = b;
    indices[kept + 2] = c;
    kept += 3;
  }
  indices.resize(kept);
}

void simplify(Arrays& mesh, double ratio) {
  std::vector<unsigned> left(mesh.indices.size());
  const std::uint64_t target = 3 * share_of(mesh.indices.size() / 3, ratio);
  const float any_error = std::numeric_limits<float>::max();
  left.resize(meshopt_simplify(left.data(), mesh.indices.data(), mesh.indices.size(),
                               mesh.positions.data(), mesh.positions.size() / 3, k_stride, target,
                               any_error, 0, nullptr));
  mesh.indices.swap(left);
}

void write(const std::string& path, Arrays& mesh) {
  MeshSinkOptions options;
  options.vertices =
      meshopt_optimizeVertexFetch(mesh.positions.data(), mesh.indices.data(), mesh.indices.size(),
                                  mesh.positions.data(), mesh.positions.size() / 3, k_stride);
  options.triangles = mesh.indices.size() / 3;
  const auto writer = create_ply(path, options);
  for (std::size_t v = 0; v < options.vertices; ++v) {
    const float* p = &mesh.positions[3 * v];
    const Vec3 position{p[0], p[1], p[2]};
    writer->vertices({&position, 1});
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Triangle triangle{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    writer->triangles(std::span<const Triangle>(&triangle, 1));
  }
  writer->commit();
}

Outcome run(const CommandLine& command) {
  Outcome outcome{"meshoptimizer", meshoptimizer_version(), {}, 0};
  outcome.watch.start();
  const auto source = open_mesh(command.input);
  if (source->info().vertices > std::numeric_limits<unsigned>::max()) {
    throw DataError(command.input + " has more vertices than meshoptimizer can index");
  }
  Arrays mesh{read_positions(*source), read_indices(*source)};
  weld(mesh);
  drop_degenerate(mesh.indices);
  simplify(mesh, command.ratio);
  outcome.triangles = mesh.indices.size() / 3;
  write(command.output, mesh);
  outcome.watch.stop();
  return outcome;
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  return meshfarm::bench::run_program(argc, argv, meshfarm::bench::run);
}
