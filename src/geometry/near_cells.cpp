// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/near_cells.hpp>

namespace meshfarm {

NearCells::NearCells(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                     double distance) {
  const Vec3 margin{distance, distance, distance};
  const auto box_of = [&](const Triangle& t) {
    Box box;
    for (const std::uint32_t v : t) box.add(positions[v]);
    return Box{box.lo - margin, box.hi + margin};
  };
  for (const Triangle& t : triangles) {
    const Box box = box_of(t);
    box_.add(box.lo);
    box_.add(box.hi);
  }
  if (box_.empty()) return;
  const Vec3 sides = box_.hi - box_.lo;
  const double size = std::max({sides.x, sides.y, sides.z}) / (k_cells - 1);
  per_unit_ = std::isnormal(size) ? 1 / size : 1;
  near_.assign(std::size_t{k_cells} * k_cells * k_cells, false);
  for (const Triangle& t : triangles) {
    const Box box = box_of(t);
    any_cell(cell_of(box.lo), cell_of(box.hi), [&](std::size_t cell) {
      near_[cell] = true;
      return false;
    });
  }
}

NearCells::Cell NearCells::cell_of(Vec3 p) const {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (p[axis] - box_.lo[axis]) * per_unit_;
    cell[static_cast<std::size_t>(axis)] = static_cast<int>(std::clamp(at, 0.0, k_cells - 1.0));
  }
  return cell;
}

template <typename Take>
bool NearCells::any_cell(Cell lo, Cell hi, const Take& take) {
  for (int z = lo[2]; z <= hi[2]; ++z) {
    for (int y = lo[1]; y <= hi[1]; ++y) {
      for (int x = lo[0]; x <= hi[0]; ++x) {
        if (take(index_of(x, y, z))) return true;
      }
    }
  }
  return false;
}

bool NearCells::touch(const Box& box) const {
  if (near_.empty() || box.empty()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.hi[axis] < box_.lo[axis] || box.lo[axis] > box_.hi[axis]) return false;
  }
  return any_cell(cell_of(box.lo), cell_of(box.hi),
                  [&](std::size_t cell) { return bool{near_[cell]}; });
}

/// Most triangles lie within a single cell.
std::vector<std::uint32_t> NearCells::touching(std::span<const Vec3> positions,
                                               std::span<const Triangle> triangles) const {
  std::vector<std::uint32_t> touching;
  if (near_.empty()) return touching;
  // Points outside the box have no cell.
  constexpr std::uint32_t k_outside = UINT32_MAX;
  std::vector<std::uint32_t> cells(positions.size(), k_outside);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!box_.contains(positions[i])) continue;
    const Cell cell = cell_of(positions[i]);
    cells[i] = static_cast<std::uint32_t>(index_of(cell[0], cell[1], cell[2]));
  }
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const bool is_in_one = cells[a] == cells[b] && cells[a] == cells[c] && cells[a] != k_outside;
    if (is_in_one ? bool{near_[cells[a]]} : touch_box_of(positions, triangles[i])) {
      touching.push_back(i);
    }
  }
  return touching;
}

bool NearCells::touch_box_of(std::span<const Vec3> positions, const Triangle& triangle) const {
  Box box;
  for (const std::uint32_t v : triangle) box.add(positions[v]);
  return touch(box);
}

}  // namespace meshfarm
