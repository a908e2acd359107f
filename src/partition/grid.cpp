// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>

#include <meshfarm/partition/grid.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_first_slots = 1024;

/// The finaliser of splitmix64: spreads neighbouring indices over the table.
std::uint64_t spread(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

UniformGrid::UniformGrid(const Box& box, unsigned bits) : lo_(box.lo), bits_(bits) {
  assert(bits <= k_max_bits);
  const Vec3 extent = box.empty() ? Vec3{} : box.hi - box.lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const double cells = static_cast<double>(std::uint64_t{1} << bits);
  if (longest > 0) cells_per_unit_ = cells / longest;
}

std::uint64_t UniformGrid::cell_of(Vec3 p) const {
  // By way of signed numbers: there is an instruction for these.
  const auto last = static_cast<double>((std::int64_t{1} << bits_) - 1);
  const auto along = [&](double x, double lo) {
    double cell = (x - lo) * cells_per_unit_;
    cell = cell > 0 ? cell : 0;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell < last ? cell : last));
  };
  return (along(p.z, lo_.z) << (2 * bits_)) | (along(p.y, lo_.y) << bits_) | along(p.x, lo_.x);
}

CellTable::CellTable() : slots_(k_first_slots, 0) {}

std::size_t CellTable::slot_of(std::uint64_t cell) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = spread(cell) & mask;
  while (slots_[slot] != 0 && cells_[slots_[slot] - 1].index != cell) slot = (slot + 1) & mask;
  return slot;
}

void CellTable::add(std::uint64_t cell, Vec3 position) {
  // Neighbours in the file are often neighbours in space.
  if (last_ >= cells_.size() || cells_[last_].index != cell) last_ = place_of(cell);
  Cell& entry = cells_[last_];
  ++entry.vertices;
  entry.mean = entry.mean + position;
}

std::size_t CellTable::place_of(std::uint64_t cell) {
  std::size_t slot = slot_of(cell);
  if (slots_[slot] == 0) {
    if ((cells_.size() + 1) * 2 > slots_.size()) {
      grow();
      slot = slot_of(cell);
    }
    cells_.push_back({cell, 0, {}});
    slots_[slot] = static_cast<std::uint32_t>(cells_.size());
  }
  return slots_[slot] - 1;
}

void CellTable::grow() {
  slots_.assign(slots_.size() * 2, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    slots_[slot_of(cells_[i].index)] = static_cast<std::uint32_t>(i + 1);
  }
}

void CellTable::finish() {
  std::sort(cells_.begin(), cells_.end(),
            [](const Cell& a, const Cell& b) { return a.index < b.index; });
  for (Cell& cell : cells_) cell.mean = cell.mean * (1.0 / static_cast<double>(cell.vertices));
  std::fill(slots_.begin(), slots_.end(), 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    slots_[slot_of(cells_[i].index)] = static_cast<std::uint32_t>(i + 1);
  }
}

std::uint32_t CellTable::number_of(std::uint64_t cell) const {
  const std::uint32_t entry = slots_[slot_of(cell)];
  assert(entry != 0);
  return entry - 1;
}

}  // namespace meshfarm
