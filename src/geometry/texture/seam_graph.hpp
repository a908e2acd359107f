// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// The lines between labels or charts of a surface, and the charts that they enclose, without
/// triangles.
struct SeamGraph {
  static constexpr std::uint32_t k_none = UINT32_MAX;

  /// A region enclosed by lines and borders.
  struct Chart {
    std::int64_t triangles = 0;
    std::int64_t euler = 0;    // characteristic of the surface cut open along all lines
    std::int64_t corners = 0;  // counted once per visit of the rim
    bool is_part = false;      // the rest is in other parts
    bool is_gone = false;
    std::vector<std::uint32_t> lines;
  };
  /// A line, or a stretch of border between two corners.
  struct Line {
    std::array<std::uint32_t, 2> corners{k_none, k_none};  // k_none: a loop without any
    std::array<std::uint32_t, 2> charts{k_none, k_none};   // the second k_none: a border
    std::uint32_t inner = 0;                               // other vertices
    double length = 0;
    bool is_gone = false;

    bool is_border() const { return charts[1] == k_none; }
    bool is_loop() const { return corners[0] == corners[1]; }
    void add_corner(std::uint32_t corner) { corners[corners[0] == k_none ? 0 : 1] = corner; }
  };
  struct Corner {
    Vec3 position;
    bool is_on_border = false;
    std::vector<std::uint32_t> lines;   // those that begin and end there: twice
    std::vector<std::uint32_t> charts;  // once per visit
  };

  std::vector<Chart> charts;
  std::vector<Line> lines;
  std::vector<Corner> corners;
};

/// The approximate minimum number of triangles. A chart with the shape of a disk keeps two fewer
/// than it has corners, and the corners stay. A chart with two corners vanishes with its last
/// triangle: its lines become one, and where only two lines are left there is no corner any more.
std::uint64_t floor_of(SeamGraph graph);

}  // namespace meshfarm
