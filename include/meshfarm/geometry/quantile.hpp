// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace meshfarm {

/// The quantile at this share: the least of the values such that at most the remaining share of
/// them is greater. Exact; 0 if there are no values. None may be NaN. Reorders the values.
template <typename Number>
Number quantile(std::span<Number> values, double share) {
  if (values.empty()) return 0;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto place = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(place, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace meshfarm
