// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/grid.hpp"

#include <algorithm>
#include <cassert>

namespace meshfarm {

UniformGrid::UniformGrid(const Box& box, unsigned bits) : lo_(box.lo), bits_(bits) {
  assert(bits <= k_max_bits);
  const Vec3 extent = box.empty() ? Vec3{} : box.hi - box.lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const double cells = static_cast<double>(std::uint64_t{1} << bits);
  if (!(longest > 0)) return;
  constexpr double k_steps = 2'147'483'648.0;
  cells_per_unit_ = cells / longest;
  steps_per_unit_ = k_steps / longest;
}

std::uint64_t UniformGrid::cell_of(Vec3 p) const {
  // Converted through a signed number, as the CPU has an instruction for that.
  const auto last = static_cast<double>((std::int64_t{1} << bits_) - 1);
  const auto along = [&](double x, double lo) {
    double cell = (x - lo) * cells_per_unit_;
    cell = cell > 0 ? cell : 0;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell < last ? cell : last));
  };
  return (along(p.z, lo_.z) << (2 * bits_)) | (along(p.y, lo_.y) << bits_) | along(p.x, lo_.x);
}

void UniformGrid::coarsen() {
  assert(bits_ > 0);
  --bits_;
  cells_per_unit_ *= 0.5;
}

std::uint64_t UniformGrid::coarser_cell(std::uint64_t finer) const {
  const unsigned bits = bits_ + 1;
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const auto along = [&](unsigned axis) { return (finer >> (axis * bits) & mask) >> 1; };
  return (along(2) << (2 * bits_)) | (along(1) << bits_) | along(0);
}

Vec3 UniformGrid::mean_of(const std::array<std::uint64_t, 3>& steps, std::uint64_t points) const {
  if (!(steps_per_unit_ > 0) || points == 0) return lo_;
  const auto along = [&](std::uint64_t sum, double lo) {
    return lo + static_cast<double>(sum) / static_cast<double>(points) / steps_per_unit_;
  };
  return {along(steps[0], lo_.x), along(steps[1], lo_.y), along(steps[2], lo_.z)};
}

void UniformGrid::put(ByteWriter& out) const {
  out.put(lo_);
  out.put(cells_per_unit_);
  out.put(steps_per_unit_);
  out.put(static_cast<std::uint32_t>(bits_));
}

UniformGrid UniformGrid::get(ByteReader& in) {
  UniformGrid grid(Box{}, 0);
  grid.lo_ = in.get<Vec3>();
  grid.cells_per_unit_ = in.get<double>();
  grid.steps_per_unit_ = in.get<double>();
  grid.bits_ = in.get<std::uint32_t>();
  if (grid.bits_ > k_max_bits) in.fail("a grid that is too fine");
  return grid;
}

}  // namespace meshfarm
