// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/area_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/random_unit.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_triangles_a_block = 128;  // fixed, as are the chunks

double area_of(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.positions[t[0]];
  return length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) / 2;
}

}  // namespace

std::vector<double> areas_before(const Mesh& mesh, unsigned threads, const char* which) {
  const std::size_t count = mesh.triangles.size();
  const std::size_t blocks = (count + k_triangles_a_block - 1) / k_triangles_a_block;
  std::vector<double> before(blocks + 1, 0.0);
  parallel_for(blocks, threads, [&](std::uint64_t block) {
    const std::size_t end = std::min(count, (block + 1) * k_triangles_a_block);
    double sum = 0;
    for (std::size_t i = block * k_triangles_a_block; i < end; ++i) sum += area_of(mesh, i);
    before[block + 1] = sum;
  });
  for (std::size_t i = 1; i <= blocks; ++i) before[i] += before[i - 1];
  if (!std::isfinite(before.back())) {
    throw DataError(std::string("cannot measure distances: the mesh to measure ") + which +
                    " has coordinates that are not finite, or too large");
  }
  return before;
}

void check_area(const std::vector<double>& before, const char* which) {
  if (!(before.back() > 0)) {
    throw DataError(std::string("cannot measure distances: the mesh to measure ") + which +
                    " has no triangle of positive area");
  }
}

AreaSampler::AreaSampler(const Mesh& mesh, const std::vector<double>& before, std::uint64_t samples)
    : mesh_(mesh), before_(before), share_(before.back() / static_cast<double>(samples)) {}

Vec3 AreaSampler::sample(std::uint64_t n) {
  seek((static_cast<double>(n) + random_unit(3 * n)) * share_);
  const Triangle& t = mesh_.triangles[triangle_];
  return random_place(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]], n);
}

// Jumps to the block that contains the place, then walks. Block sums and walked sums may differ in
// the last bit, so a walk may end on the next triangle: that is on the surface as well.
void AreaSampler::seek(double place) {
  const auto next = std::upper_bound(before_.begin() + 1, before_.end() - 1, place);
  const auto block = static_cast<std::size_t>(next - before_.begin()) - 1;
  if (block != block_) {
    block_ = block;
    triangle_ = block * k_triangles_a_block;
    walked_ = before_[block] + area_of(mesh_, triangle_);
  }
  const std::size_t end = std::min(mesh_.triangles.size(), (block + 1) * k_triangles_a_block) - 1;
  while (walked_ < place && triangle_ < end) walked_ += area_of(mesh_, ++triangle_);
}

}  // namespace meshfarm
