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

/// Corners that lie at one point get one index, and triangles with two of them go.
std::vector<unsigned> welded(const std::vector<unsigned>& indices,
                             const std::vector<float>& positions) {
  std::vector<unsigned> joined(indices.size());
  meshopt_generateShadowIndexBuffer(joined.data(), indices.data(), indices.size(), positions.data(),
                                    positions.size() / 3, k_stride, k_stride);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < joined.size(); i += 3) {
    const unsigned a = joined[i];
    const unsigned b = joined[i + 1];
    const unsigned c = joined[i + 2];
    if (a == b || b == c || c == a) continue;
    joined[kept] = a;
    joined[kept + 1] = b;
    joined[kept + 2] = c;
    kept += 3;
  }
  joined.resize(kept);
  return joined;
}

void simplify(std::vector<unsigned>& indices, const std::vector<float>& positions, double ratio) {
  std::vector<unsigned> left(indices.size());
  const float any_error = std::numeric_limits<float>::max();
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), positions.data(),
                               positions.size() / 3, k_stride,
                               3 * share_of(indices.size() / 3, ratio), any_error, 0, nullptr));
  indices.swap(left);
}

void write(const std::string& path, std::vector<unsigned>& indices, std::vector<float>& positions) {
  PlyWriterOptions options;
  options.vertices = meshopt_optimizeVertexFetch(positions.data(), indices.data(), indices.size(),
                                                 positions.data(), positions.size() / 3, k_stride);
  options.triangles = indices.size() / 3;
  PlyWriter writer(path, options);
  for (std::size_t v = 0; v < options.vertices; ++v) {
    const float* p = &positions[3 * v];
    const Vec3 position{p[0], p[1], p[2]};
    writer.vertices({&position, 1});
  }
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Triangle triangle{indices[i], indices[i + 1], indices[i + 2]};
    writer.triangles(std::span<const Triangle>(&triangle, 1));
  }
  writer.commit();
}

Outcome run(const CommandLine& command) {
  Outcome outcome{"meshoptimizer, file to file", meshoptimizer_version(), {}, 0};
  outcome.watch.start();
  const auto source = open_mesh(command.input);
  if (source->info().vertices > std::numeric_limits<unsigned>::max()) {
    throw DataError(command.input + " has more vertices than meshoptimizer can index");
  }
  std::vector<float> positions = read_positions(*source);
  std::vector<unsigned> indices = welded(read_indices(*source), positions);
  simplify(indices, positions, command.ratio);
  outcome.triangles = indices.size() / 3;
  write(command.output, indices, positions);
  outcome.watch.stop();
  return outcome;
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  return meshfarm::bench::run_program(argc, argv, meshfarm::bench::run);
}
