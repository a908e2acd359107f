// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/sample_cells.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace meshfarm {
namespace {

using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

constexpr std::size_t k_from_first = 512;  // vertices measured relative to the first of them
constexpr double k_unit = 0x1p-24;         // relative rounding error of a float
constexpr std::int32_t k_no_cell = 0xffff;

/// Camera::Rows of all cameras, one per lane. Lanes without a camera project everything to one
/// point.
struct LaneRows {
  std::array<Floats, 3> x{}, y{}, z{};
  Floats middle_x{}, middle_y{};
  Floats scale{};  // for errors: samples per unit at distance 1
  Floats end_x{}, end_y{};
};

LaneRows rows_of(std::span<const Camera* const> cameras) {
  LaneRows rows;
  for (std::size_t lane = 0; lane < cameras.size(); ++lane) {
    const Camera::Rows row = cameras[lane]->rows();
    const auto set = [lane](std::array<Floats, 3>& to, Vec3 from) {
      to[0][lane] = static_cast<float>(from.x);
      to[1][lane] = static_cast<float>(from.y);
      to[2][lane] = static_cast<float>(from.z);
    };
    set(rows.x, row.x);
    set(rows.y, row.y);
    set(rows.z, row.z);
    rows.middle_x[lane] = static_cast<float>(row.middle_x);
    rows.middle_y[lane] = static_cast<float>(row.middle_y);
    rows.scale[lane] = static_cast<float>(row.scale);
    rows.end_x[lane] = static_cast<float>(std::min(65534.0, 2 * row.middle_x + 2));
    rows.end_y[lane] = static_cast<float>(std::min(65534.0, 2 * row.middle_y + 2));
  }
  return rows;
}

/// The projection of a block's first vertex, exact except for the last rounding, and error bounds
/// for the block's other vertices.
struct BlockStart {
  Floats x{}, y{}, z{};
  Floats off_by_nearness{}, off{};

  BlockStart(std::span<const Camera* const> cameras, Vec3 first, double reach) {
    for (std::size_t lane = 0; lane < cameras.size(); ++lane) {
      const Camera::Rows row = cameras[lane]->rows();
      const double to_x = dot(row.x, first) + row.x0;
      const double to_y = dot(row.y, first) + row.y0;
      const double to_z = dot(row.z, first) + row.z0;
      x[lane] = static_cast<float>(to_x);
      y[lane] = static_cast<float>(to_y);
      z[lane] = static_cast<float>(to_z);
      // Eight roundings in the sum, and as many in the distance it is divided by, doubled to be
      // safe.
      const double far = std::max(std::abs(to_x), std::abs(to_y)) + std::abs(to_z) * row.scale;
      off_by_nearness[lane] = static_cast<float>(32 * k_unit * (3 * reach * row.scale + far));
      off[lane] = static_cast<float>(32 * k_unit * (row.middle_x + row.middle_y + 2));
    }
  }
};

Floats chosen(Ints mask, Floats values) {
  return reinterpret_cast<Floats>(mask & reinterpret_cast<Ints>(values));
}

/// Rounds down, or returns k_no_cell if the result is in doubt.
Ints cells_below(Floats at, Floats end, Floats off) {
  const Floats near = chosen((at > 0) & (at < end), at);  // 0 for NaN
  const Ints whole = __builtin_convertvector(near, Ints);
  const Floats beyond = near - __builtin_convertvector(whole, Floats);
  const Ints is_sure = (beyond > off) & (beyond < 1 - off);
  return (whole | ~is_sure) & k_no_cell;
}

}  // namespace

SampleCells::SampleCells(std::span<const Camera* const> cameras, std::span<const Vec3> positions)
    : cells_(std::make_unique_for_overwrite<Lanes[]>(positions.size())) {
  assert(cameras.size() <= k_most_cameras);
  const LaneRows rows = rows_of(cameras);
  std::array<std::array<float, 3>, k_from_first> from_first;
  for (std::size_t begin = 0; begin < positions.size(); begin += k_from_first) {
    const std::size_t count = std::min(k_from_first, positions.size() - begin);
    const Vec3 first = positions[begin];
    double reach = 0;  // a NaN has no cell anyway
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = positions[begin + i] - first;
      reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      from_first[i] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    const BlockStart start(cameras, first, reach);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [x, y, z] = from_first[i];
      const Floats to_x = rows.x[0] * x + rows.x[1] * y + rows.x[2] * z + start.x;
      const Floats to_y = rows.y[0] * x + rows.y[1] * y + rows.y[2] * z + start.y;
      const Floats distance = rows.z[0] * x + rows.z[1] * y + rows.z[2] * z + start.z;
      const Floats nearness = 1 / distance;
      const Floats off = start.off_by_nearness * nearness + start.off;
      const Ints is_before = distance > 0;
      const Ints column =
          cells_below(chosen(is_before, rows.middle_x + to_x * nearness), rows.end_x, off);
      const Ints row =
          cells_below(chosen(is_before, rows.middle_y + to_y * nearness), rows.end_y, off);
      cells_[begin + i] = reinterpret_cast<Lanes>(column << 16 | row);
    }
  }
  for (std::size_t lane = cameras.size(); lane < k_most_cameras; ++lane) {
    for (std::size_t i = 0; i < positions.size(); ++i) cells_[i][lane] = 0;
  }
}

}  // namespace meshfarm
