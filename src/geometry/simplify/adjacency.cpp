// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/adjacency.hpp"

#include <algorithm>
#include <limits>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

void Adjacency::build(std::span<const Triangle> triangles, std::size_t vertices,
                      const TriangleColumnsView& columns) {
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
  columns_ = columns;
  put_ids(triangles);
}

/// Fills the ids in the order of the corners.
void Adjacency::put_ids(std::span<const Triangle> triangles) {
  ids_.resize(columns_.empty() ? 0 : corners_.size());
  if (columns_.empty()) return;
  std::vector<std::uint32_t> next(rows_.size());
  for (std::size_t v = 0; v < rows_.size(); ++v) next[v] = rows_[v].begin;
  CornerId id = 0;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ids_[next[v]++] = id++;
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
    ids_.insert(ids_.end(), fan.ids.begin(), fan.ids.end());
  } else {
    std::copy(corners.begin(), corners.end(), corners_.begin() + row.begin);
    if (!ids_.empty()) std::copy(fan.ids.begin(), fan.ids.end(), ids_.begin() + row.begin);
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
    if (!ids_.empty()) ids_[kept] = ids_[i];
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
  if (!ids_.empty()) {
    const auto id = ids_.begin() + (at - corners_.begin());
    std::copy(id + 1, ids_.begin() + row.end, id);
  }
  std::copy(at + 1, end, at);
  --row.end;
}

}  // namespace meshfarm
