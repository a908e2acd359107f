// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace meshfarm {

/// Values, each with its weight: the area that it stands for.
class WeightedValues {
 public:
  /// Values and weights; numbers all.
  explicit WeightedValues(std::vector<std::pair<double, double>> values)
      : values_(std::move(values)) {
    for (const auto& [value, weight] : values_) weight_ += weight;
  }
  /// In any order.
  const std::vector<std::pair<double, double>>& values() const { return values_; }
  double weight() const { return weight_; }
  /// The least value that at most the rest of this share of the weight is beyond; 0 if there are
  /// none. Takes time in proportion to their number, and changes their order.
  double quantile(double share) {
    if (values_.empty()) return 0;
    auto begin = values_.begin();
    auto end = values_.end();
    for (double before = 0; end - begin > 1;) {
      const auto middle = begin + (end - begin) / 2;
      std::nth_element(begin, middle, end);
      double lower = before;
      for (auto at = begin; at != middle; ++at) lower += at->second;
      if (lower >= share * weight_) {
        end = middle;
      } else {
        begin = middle;
        before = lower;
      }
    }
    return begin->first;
  }

 private:
  std::vector<std::pair<double, double>> values_;
  double weight_ = 0;
};

}  // namespace meshfarm
