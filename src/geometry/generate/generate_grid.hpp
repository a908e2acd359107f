// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/geometry/generate.hpp>

namespace meshfarm {

/// Throws UsageError for fewer triangles than `least`, or an absurd number.
void check_size(std::uint64_t triangles, std::uint64_t least);

struct Grid {
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
};

/// The grid with the number of cells nearest to `cells`, among those with about `shape` times as
/// many rows as columns; if two are equally near, the one with the better shape.
Grid nearest_grid(std::uint64_t cells, double shape);

/// Collects vertices or triangles, and passes them on in batches.
template <class T>
class Batches {
 public:
  explicit Batches(const std::function<void(std::span<const T>)>& take) : take_(take) {}
  void add(const T& item) {
    batch_.push_back(item);
    if (batch_.size() == k_batch) finish();
  }
  /// Passes on the last batch.
  void finish() {
    if (!batch_.empty()) take_(batch_);
    batch_.clear();
  }

 private:
  static constexpr std::size_t k_batch = 1 << 14;
  const std::function<void(std::span<const T>)>& take_;
  std::vector<T> batch_;
};

/// Adds two triangles for a grid cell whose corners are counter-clockwise seen from outside.
inline void add_cell(Batches<GeneratedMesh::Corners>& triangles,
                     const std::array<std::uint64_t, 4>& cell) {
  const auto [a, b, c, d] = cell;
  triangles.add({a, b, c});
  triangles.add({a, c, d});
}

}  // namespace meshfarm
