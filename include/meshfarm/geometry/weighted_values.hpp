// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace meshfarm {

/// Values, each with a weight: the area that it represents.
class WeightedValues {
 public:
  /// Pairs of value and weight; none is NaN.
  explicit WeightedValues(std::vector<std::pair<double, double>> values)
      : values_(std::move(values)) {
    for (const auto& [value, weight] : values_) weight_ += weight;
  }
  /// In any order.
  const std::vector<std::pair<double, double>>& values() const { return values_; }
  double weight() const { return weight_; }
  /// The quantile at this share of the weight: the least value such that at most the remaining
  /// weight lies beyond it; 0 if there are no values. Takes time proportional to the number of
  /// values, or to those beyond the previous share if that was smaller. Reorders the values.
  double quantile(double share) {
    if (values_.empty()) return 0;
    if (share < share_) found_ = {};
    share_ = share;
    auto begin = values_.begin() + found_.place;
    auto end = values_.end();
    double before = found_.weight_before;
    while (end - begin > 1) {
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
    found_ = {begin - values_.begin(), before};
    return begin->first;
  }

 private:
  std::vector<std::pair<double, double>> values_;
  double weight_ = 0;
  /// The last quantile: smaller values lie before it, greater ones after it.
  struct Found {
    std::ptrdiff_t place = 0;
    double weight_before = 0;
  };
  Found found_;
  double share_ = 0;
};

}  // namespace meshfarm
