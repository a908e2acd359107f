// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The leanest whole run with meshoptimizer that we know: the file is mapped and scanned straight
// into its arrays, its own functions weld and compact, and the clock runs from open to close.
#include <cmath>
#include <limits>
#include <utility>
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
