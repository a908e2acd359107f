// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/simplify/simplify_rank.hpp"

namespace meshfarm {

/// The number of collapses at each cost, to a factor of two.
class CostCounts {
 public:
  /// Negative costs and NaN count as 0.
  void add(double cost) {
    ++counts_[class_of(cost)];
    ++all_;
  }

  /// The number of expensive collapses: all that cost at least 1/64 of the greatest cost, and none
  /// that cost less than 1/128.
  std::uint64_t dear() const {
    std::uint64_t found = 0;
    std::size_t left = k_dear_classes;
    for (std::size_t i = counts_.size(); i > 0 && left > 0; --i) {
      found += counts_[i - 1];
      left -= found > 0 ? 1 : 0;
    }
    return found;
  }

  /// A cost that this share of all collapses is below; at most twice the least such cost. Close to
  /// 0 if they cost nothing.
  double quantile(double share) const {
    const double wanted = share * static_cast<double>(all_);
    std::uint64_t found = 0;
    std::size_t i = 0;
    for (; i + 1 < counts_.size(); ++i) {
      found += counts_[i];
      if (static_cast<double>(found) >= wanted) break;
    }
    return cost_of(static_cast<CostKey>((i + 1) << k_shift));
  }

 private:
  static constexpr int k_shift = 20;  // of a key: its exponent
  static constexpr std::size_t k_dear_classes = 7;

  static std::size_t class_of(double cost) { return key_of(cost > 0 ? cost : 0) >> k_shift; }

  std::array<std::uint32_t, (k_any_cost >> k_shift) + 1> counts_{};
  std::uint64_t all_ = 0;
};

}  // namespace meshfarm
