// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/cell_neighbours.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include <meshfarm/geometry/point_index.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_chunk = 2048;  // cells that a thread takes at once

/// Finds the cells beside a cell in the sorted keys. Call it for cells in ascending order: it goes
/// along each of the nine rows once.
class CellsBeside {
 public:
  CellsBeside(std::span<const std::uint64_t> keys, std::span<const unsigned> grid_bits,
              std::size_t first)
      : keys_(keys), grid_bits_(grid_bits) {
    at_.fill(k_nowhere);
    if (first == 0) at_.fill(0);
  }

  /// Shows each of them, without the cell itself.
  template <typename Show>
  void show(std::size_t cell, const Show& show) {
    const std::uint64_t key = keys_[cell];
    const std::uint64_t grid = key >> CellTree::k_index_bits;
    if (grid >= grid_bits_.size()) return;
    const unsigned bits = grid_bits_[grid];
    const std::uint64_t last = (std::uint64_t{1} << bits) - 1;
    const auto [x, y, z] = CellTree::places_of(key, bits);
    std::size_t row = 0;
    for (std::uint64_t dz = 0; dz < 3; ++dz) {
      for (std::uint64_t dy = 0; dy < 3; ++dy, ++row) {
        if (z + dz < 1 || z + dz - 1 > last || y + dy < 1 || y + dy - 1 > last) continue;
        const std::uint64_t begin =
            grid << CellTree::k_index_bits | (z + dz - 1) << (2 * bits) | (y + dy - 1) << bits;
        const std::uint64_t end = begin + std::min(x + 1, last);
        for (std::size_t i = first_from(row, begin + (x > 0 ? x - 1 : 0));
             i < keys_.size() && keys_[i] <= end; ++i) {
          if (i != cell) show(static_cast<std::uint32_t>(i));
        }
      }
    }
  }

 private:
  static constexpr std::size_t k_nowhere = static_cast<std::size_t>(-1);

  std::size_t first_from(std::size_t row, std::uint64_t key) {
    std::size_t& at = at_[row];
    if (at == k_nowhere) {
      at = static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) -
                                    keys_.begin());
    }
    while (at < keys_.size() && keys_[at] < key) ++at;
    return at;
  }

  std::span<const std::uint64_t> keys_;
  std::span<const unsigned> grid_bits_;
  std::array<std::size_t, 9> at_{};
};

}  // namespace

std::vector<std::uint32_t> cell_neighbours(std::span<const Cell> cells,
                                           std::span<const unsigned> grid_bits, std::size_t k,
                                           unsigned threads) {
  std::vector<std::uint64_t> keys;
  std::vector<Vec3> means;
  keys.reserve(cells.size());
  means.reserve(cells.size());
  for (const Cell& cell : cells) {
    keys.push_back(cell.key);
    means.push_back(cell.mean);
  }
  std::vector<std::uint32_t> neighbours(cells.size() * k, k_no_cell);
  std::atomic<bool> some_lack = false;
  const auto for_chunks = [&](const auto& take) {
    parallel_for((cells.size() + k_chunk - 1) / k_chunk, threads, [&](std::uint64_t chunk) {
      take(chunk * k_chunk, std::min<std::size_t>(cells.size(), (chunk + 1) * k_chunk));
    });
  };
  for_chunks([&](std::size_t first, std::size_t end) {
    CellsBeside beside(keys, grid_bits, first);
    std::vector<std::pair<double, std::uint32_t>> found;
    for (std::size_t i = first; i < end; ++i) {
      found.clear();
      beside.show(i, [&](std::uint32_t other) {
        found.emplace_back(squared_length(means[other] - means[i]), other);
      });
      if (found.size() < k) {
        some_lack = true;
        continue;
      }
      const auto last = found.begin() + static_cast<std::ptrdiff_t>(k);
      if (last != found.end()) std::nth_element(found.begin(), last, found.end());
      for (std::size_t n = 0; n < k; ++n) neighbours[i * k + n] = found[n].second;
    }
  });
  if (k == 0 || !some_lack) return neighbours;

  const PointIndex index(means);
  for_chunks([&](std::size_t first, std::size_t end) {
    std::vector<std::uint32_t> found(k + 1);
    for (std::size_t i = first; i < end; ++i) {
      if (neighbours[i * k] != k_no_cell) continue;
      const std::size_t count = index.nearest(means[i], found);
      std::size_t n = 0;
      for (std::size_t f = 0; f < count && n < k; ++f) {
        if (found[f] != i) neighbours[i * k + n++] = found[f];
      }
    }
  });
  return neighbours;
}

}  // namespace meshfarm
