// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace meshfarm {

/// Values in order, each with its weight: the area that it stands for.
class WeightedValues {
 public:
  /// Values and weights; numbers all.
  explicit WeightedValues(std::vector<std::pair<double, double>> values)
      : values_(std::move(values)) {
    std::sort(values_.begin(), values_.end());
    for (const auto& [value, weight] : values_) weight_ += weight;
  }
  const std::vector<std::pair<double, double>>& values() const { return values_; }
  double weight() const { return weight_; }
  /// The least value that at most the rest of this share of the weight is beyond; 0 if there are
  /// none.
  double quantile(double share) const {
    double before = 0;
    for (const auto& [value, weight] : values_) {
      before += weight;
      if (before >= share * weight_) return value;
    }
    return values_.empty() ? 0 : values_.back().first;
  }

 private:
  std::vector<std::pair<double, double>> values_;
  double weight_ = 0;
};

}  // namespace meshfarm
