// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

TriangleIndex::TriangleIndex(const Mesh& mesh, unsigned threads)
    : mesh_(mesh), bvh_(std::make_unique<Bvh>(mesh, threads)) {}
TriangleIndex::~TriangleIndex() = default;
TriangleIndex::TriangleIndex(TriangleIndex&&) noexcept = default;

std::vector<float> distances_to(const TriangleIndex& index, std::span<const Vec3> points,
                                unsigned threads) {
  constexpr std::size_t k_chunk = 4096;
  std::vector<float> distances(points.size(), 0);
  parallel_for((points.size() + k_chunk - 1) / k_chunk, threads, [&](std::uint64_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * k_chunk);
    std::uint32_t guess = 0;
    for (std::size_t i = chunk * k_chunk; i < end; ++i) {
      if (!is_finite(points[i])) continue;
      const Bvh::Nearest nearest = index.bvh().nearest(points[i], guess);
      guess = nearest.triangle;
      distances[i] = static_cast<float>(std::sqrt(nearest.squared));
    }
  });
  return distances;
}

}  // namespace meshfarm
