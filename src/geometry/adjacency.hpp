// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// One triangle seen from one of its vertices: the other two, counter-clockwise.
struct Corner {
  std::uint32_t next;
  std::uint32_t prev;
};

/// The corners at each vertex in one flat array (compressed sparse rows), in triangle order.
class Adjacency {
 public:
  /// Keeps its memory from one build to the next.
  void build(std::span<const Triangle> triangles, std::size_t vertices);
  std::uint32_t vertices() const {
    return offsets_.empty() ? 0 : static_cast<std::uint32_t>(offsets_.size() - 2);
  }
  std::span<const Corner> at(std::uint32_t vertex) const {
    return {corners_.data() + offsets_[vertex], corners_.data() + offsets_[vertex + 1]};
  }
  std::uint32_t count(std::uint32_t vertex) const {
    return offsets_[vertex + 1] - offsets_[vertex];
  }

 private:
  std::vector<std::uint32_t> offsets_;
  std::vector<Corner> corners_;
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
