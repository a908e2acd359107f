// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/adjacency.hpp"

#include <algorithm>
#include <limits>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

void Adjacency::build(std::span<const Triangle> triangles, std::size_t vertices,
                      std::span<const Label> labels) {
  rows_.assign(vertices, {0, 0});
  corners_.resize(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ++rows_[v].end;
  }
  std::uint32_t first = 0;
  for (Row& row : rows_) {
    const std::uint32_t count = row.end;
    row = {first, first};
    first += count;
  }
  for (const Triangle& t : triangles) {
    corners_[rows_[t[0]].end++] = {t[1], t[2]};
    corners_[rows_[t[1]].end++] = {t[2], t[0]};
    corners_[rows_[t[2]].end++] = {t[0], t[1]};
  }
  put_labels(triangles, labels);
}

/// Beside the corners, in their order.
void Adjacency::put_labels(std::span<const Triangle> triangles, std::span<const Label> labels) {
  labels_.resize(labels.empty() ? 0 : corners_.size());
  if (labels.empty()) return;
  std::vector<std::uint32_t> next(rows_.size());
  for (std::size_t v = 0; v < rows_.size(); ++v) next[v] = rows_[v].begin;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t v : triangles[i]) labels_[next[v]++] = labels[i];
  }
}

void Adjacency::assign(std::uint32_t vertex, const CornerFan& fan) {
  const std::span<const Corner> corners = fan.corners;
  Row& row = rows_[vertex];
  const auto count = static_cast<std::uint32_t>(corners.size());
  if (count > row.end - row.begin) {
    if (corners_.size() + count > std::numeric_limits<std::uint32_t>::max()) {
      throw UsageError("simplify: the mesh is too big for 32-bit indices; ask for fewer triangles");
    }
    row.begin = static_cast<std::uint32_t>(corners_.size());
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    labels_.insert(labels_.end(), fan.labels.begin(), fan.labels.end());
  } else {
    std::copy(corners.begin(), corners.end(), corners_.begin() + row.begin);
    std::copy(fan.labels.begin(), fan.labels.end(), labels_.begin() + row.begin);
  }
  row.end = row.begin + count;
}

std::uint32_t Adjacency::add_vertex() {
  rows_.push_back({0, 0});
  return static_cast<std::uint32_t>(rows_.size() - 1);
}

void Adjacency::replace(std::uint32_t vertex, std::uint32_t was, std::uint32_t now) {
  Row& row = rows_[vertex];
  std::uint32_t kept = row.begin;
  for (std::uint32_t i = row.begin; i < row.end; ++i) {
    Corner c = corners_[i];
    if (c.next == was) c.next = now;
    if (c.prev == was) c.prev = now;
    if (c.next == c.prev) continue;
    if (!labels_.empty()) labels_[kept] = labels_[i];
    corners_[kept++] = c;
  }
  row.end = kept;
}

void Adjacency::replace(std::uint32_t vertex, Corner was, Corner now) {
  const Row& row = rows_[vertex];
  const auto end = corners_.begin() + row.end;
  const auto at = std::find(corners_.begin() + row.begin, end, was);
  if (at != end) *at = now;
}

void Adjacency::remove(std::uint32_t vertex, Corner corner) {
  Row& row = rows_[vertex];
  const auto end = corners_.begin() + row.end;
  const auto at = std::find(corners_.begin() + row.begin, end, corner);
  if (at == end) return;
  if (!labels_.empty()) {
    const auto label = labels_.begin() + (at - corners_.begin());
    std::copy(label + 1, labels_.begin() + row.end, label);
  }
  std::copy(at + 1, end, at);
  --row.end;
}

}  // namespace meshfarm
