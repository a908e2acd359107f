// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/corner_ids.hpp"

namespace meshfarm {

/// One triangle seen from one of its vertices: the other two, counter-clockwise.
struct Corner {
  std::uint32_t next;
  std::uint32_t prev;
  friend bool operator==(const Corner&, const Corner&) = default;
};

inline bool has_corner(const Triangle& t, std::uint32_t vertex) {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

/// The place of a vertex in a triangle; 3 if it is not there.
inline std::size_t place_of(const Triangle& triangle, std::uint32_t vertex) {
  return static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), vertex) -
                                  triangle.begin());
}

/// The triangle must have the vertex.
inline Corner corner_at(const Triangle& triangle, std::uint32_t vertex) {
  const std::size_t at = place_of(triangle, vertex);
  return {triangle[(at + 1) % 3], triangle[(at + 2) % 3]};
}

/// The corners at a vertex, and their ids if triangles have columns.
struct CornerFan {
  std::span<const Corner> corners;
  std::span<const CornerId> ids;
  const TriangleColumnsView* columns = nullptr;  // where there are ids

  /// Whether columns make a line of the edge where triangle i ends and k begins.
  bool differ(std::size_t i, std::size_t k) const {
    return columns != nullptr && are_apart(*columns, ids[i], ids[k]);
  }
  bool labels_differ(std::size_t i, std::size_t k) const {
    return columns != nullptr && are_of_two_labels(*columns, ids[i], ids[k]);
  }
};

/// The corners at each vertex in one flat array (compressed sparse rows), in triangle order.
class Adjacency {
 public:
  /// Keeps its memory from one build to the next. The columns must not move in memory while fans
  /// are in use; their contents may change.
  void build(std::span<const Triangle> triangles, std::size_t vertices,
             const TriangleColumnsView& columns = {});
  bool has_labels() const { return !columns_.labels.empty(); }
  bool has_uvs() const { return !columns_.uvs.empty(); }
  const TriangleColumnsView& columns() const { return columns_; }
  /// The corners with their ids.
  CornerFan fan_at(std::uint32_t vertex) const {
    const Row& row = rows_[vertex];
    if (ids_.empty()) return {at(vertex), {}};
    return {at(vertex), {ids_.data() + row.begin, ids_.data() + row.end}, &columns_};
  }
  std::uint32_t vertices() const { return static_cast<std::uint32_t>(rows_.size()); }
  std::span<const Corner> at(std::uint32_t vertex) const {
    const Row& row = rows_[vertex];
    return {corners_.data() + row.begin, corners_.data() + row.end};
  }
  std::uint32_t count(std::uint32_t vertex) const {
    return rows_[vertex].end - rows_[vertex].begin;
  }

  // Changes to single vertices; the caller keeps the rows of a triangle's three vertices in step.

  /// Replaces the corners of a vertex, with their ids if there are any; `fan` must not be a part of
  /// this. A row that grows moves to the end of the array. Throws UsageError if that is too long
  /// for 32-bit indices.
  void assign(std::uint32_t vertex, const CornerFan& fan);
  /// Adds a vertex without corners and returns its number.
  std::uint32_t add_vertex();
  /// Replaces `was` by `now` in the corners of a vertex, and drops those that lose their area.
  void replace(std::uint32_t vertex, std::uint32_t was, std::uint32_t now);
  /// Replaces one corner of a vertex by `now`.
  void replace(std::uint32_t vertex, Corner was, Corner now);
  /// Removes one corner of a vertex, if it is there.
  void remove(std::uint32_t vertex, Corner corner);

 private:
  struct Row {
    std::uint32_t begin;
    std::uint32_t end;
  };
  void put_ids(std::span<const Triangle> triangles);

  std::vector<Row> rows_;
  std::vector<Corner> corners_;
  std::vector<CornerId> ids_;  // one per corner, or none
  TriangleColumnsView columns_;
};

/// Calls take(corner, end) for the edges of one fan that have one triangle: none if it is closed,
/// two if it is open. `end` is the edge's other vertex.
template <typename Take>
void for_border_edges(std::span<const Corner> fan, const Take& take) {
  for (const Corner& c : fan) {
    bool next_alone = true;
    bool prev_alone = true;
    for (const Corner& other : fan) {
      next_alone = next_alone && other.prev != c.next;
      prev_alone = prev_alone && other.next != c.prev;
    }
    if (next_alone) take(c, c.next);
    if (prev_alone) take(c, c.prev);
  }
}

}  // namespace meshfarm
