// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <meshfarm/geometry/distance.hpp>

namespace meshfarm {

/// The sums behind Distance, added up chunk by chunk.
struct DistanceSums {
  double squares = 0;
  double distances = 0;
  double max_square = 0;

  void add(const DistanceSums& other) {
    squares += other.squares;
    distances += other.distances;
    max_square = std::max(max_square, other.max_square);
  }
  Distance over(std::uint64_t count) const {
    const auto samples = static_cast<double>(std::max<std::uint64_t>(1, count));
    return {std::sqrt(squares / samples), distances / samples, std::sqrt(max_square)};
  }
};

}  // namespace meshfarm
