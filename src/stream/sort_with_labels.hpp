// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Sorts triangles, and their labels with them if there are any: equal triangles by their labels,
/// so that the order they came in does not count.
template <typename T>
void sort_with_labels(std::vector<T>& triangles, std::vector<Label>& labels) {
  if (labels.empty()) return std::sort(triangles.begin(), triangles.end());
  std::vector<std::pair<T, Label>> both(triangles.size());
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = {triangles[i], labels[i]};
  std::sort(both.begin(), both.end());
  for (std::size_t i = 0; i < both.size(); ++i) std::tie(triangles[i], labels[i]) = both[i];
}

}  // namespace meshfarm
