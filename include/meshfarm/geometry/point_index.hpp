// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// A k-d tree over fixed points. Several threads may query it at once.
class PointIndex {
 public:
  explicit PointIndex(std::vector<Vec3> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  std::span<const Vec3> points() const;

  /// Writes the indices of the nearest points to `found`, nearest first, and returns how many were
  /// written: as many as there is room for, or all.
  std::size_t nearest(Vec3 from, std::span<std::uint32_t> found) const;

  /// The least of `most` and the `value` of the points, visited nearest first, as long as their
  /// squared distance is below the least so far.
  double least(Vec3 from, double most,
               const std::function<double(std::uint32_t point)>& value) const;

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace meshfarm
