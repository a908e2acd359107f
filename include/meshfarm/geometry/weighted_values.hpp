// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
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
  /// none. Takes time in proportion to their number, or to those beyond the share before if that
  /// was less. Changes their order.
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
  /// The last quantile: what is less lies before it, what is greater behind it.
  struct Found {
    std::ptrdiff_t place = 0;
    double weight_before = 0;
  };
  Found found_;
  double share_ = 0;
};

}  // namespace meshfarm
