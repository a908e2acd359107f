// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_measured_a_block = 8192;  // fixed, so that sums are too
constexpr double k_steps_a_degree = 1000;
constexpr std::size_t k_greatest_step = 60'000;  // a smallest angle has at most 60 degrees
const double k_degrees = 180 / std::acos(-1.0);

/// The angle at the corner opposite the shortest side.
double smallest_angle(const std::array<Vec3, 3>& corners) {
  std::size_t narrowest = 0;
  double shortest = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = squared_length(corners[(k + 2) % 3] - corners[(k + 1) % 3]);
    if (side >= shortest) continue;
    shortest = side;
    narrowest = k;
  }
  const Vec3 u = corners[(narrowest + 1) % 3] - corners[narrowest];
  const Vec3 v = corners[(narrowest + 2) % 3] - corners[narrowest];
  return std::atan2(length(cross(u, v)), dot(u, v)) * k_degrees;
}

}  // namespace

ShapeMeter::ShapeMeter(unsigned threads) : threads_(threads), angles_(k_greatest_step + 1) {}

ShapeMeter::Sums ShapeMeter::measure_block(std::span<const Vec3> positions,
                                           std::span<const Triangle> triangles,
                                           std::vector<std::uint32_t>& angles) const {
  Sums sums;
  for (const auto& [first, second, third] : triangles) {
    const Vec3 a = positions[first], b = positions[second], c = positions[third];
    const Vec3 normal = cross(b - a, c - a);
    sums.area += length(normal) / 2;
    sums.volume += dot(a - *origin_, normal) / 6;
    if (a == b || b == c || c == a) continue;
    const double angle = smallest_angle({a, b, c});
    sums.below_5 += angle < 5 ? 1 : 0;
    const auto step = static_cast<std::uint32_t>(std::lround(angle * k_steps_a_degree));
    angles.push_back(std::min<std::uint32_t>(step, k_greatest_step));
  }
  return sums;
}

void ShapeMeter::add(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  if (!origin_) origin_ = positions[triangles.front()[0]];
  std::vector<Sums> blocks((triangles.size() + k_measured_a_block - 1) / k_measured_a_block);
  std::mutex mutex;
  parallel_for(blocks.size(), threads_, [&](std::uint64_t i) {
    const std::size_t first = i * k_measured_a_block;
    const auto block =
        triangles.subspan(first, std::min(k_measured_a_block, triangles.size() - first));
    std::vector<std::uint32_t> angles;
    angles.reserve(block.size());
    blocks[i] = measure_block(positions, block, angles);
    const std::lock_guard lock(mutex);
    for (const std::uint32_t step : angles) ++angles_[step];
    triangles_ += angles.size();
  });
  for (const Sums& block : blocks) {
    sums_.area += block.area;
    sums_.volume += block.volume;
    sums_.below_5 += block.below_5;
  }
}

ShapeMeasures ShapeMeter::measures() const {
  if (triangles_ == 0) return {sums_.area, sums_.volume, 0, 0};
  const std::uint64_t rank = (triangles_ + 99) / 100;
  std::size_t step = 0;
  for (std::uint64_t seen = angles_[0]; seen < rank; seen += angles_[step]) ++step;
  return {sums_.area, sums_.volume, static_cast<double>(step) / k_steps_a_degree,
          static_cast<double>(sums_.below_5) / static_cast<double>(triangles_)};
}

}  // namespace meshfarm
