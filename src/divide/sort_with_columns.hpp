// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Sorts triangles together with their columns: equal triangles by their columns, so that the
/// original order does not matter.
template <typename T>
void sort_with_columns(std::vector<T>& triangles, TriangleColumns& columns) {
  if (columns.empty()) return std::sort(triangles.begin(), triangles.end());
  struct Record {
    T triangle{};
    Label label = 0;
    CornerUvs uvs{};
    auto operator<=>(const Record&) const = default;
  };
  std::vector<Record> records(triangles.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].triangle = triangles[i];
    if (!columns.labels.empty()) records[i].label = columns.labels[i];
    if (!columns.uvs.empty()) records[i].uvs = columns.uvs[i];
  }
  std::sort(records.begin(), records.end(), [](const Record& a, const Record& b) { return a < b; });
  for (std::size_t i = 0; i < records.size(); ++i) {
    triangles[i] = records[i].triangle;
    if (!columns.labels.empty()) columns.labels[i] = records[i].label;
    if (!columns.uvs.empty()) columns.uvs[i] = records[i].uvs;
  }
}

}  // namespace meshfarm
