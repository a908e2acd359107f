// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// The lines between labels or charts of a surface, and what they enclose, without its triangles.
struct SeamGraph {
  static constexpr std::uint32_t k_none = UINT32_MAX;

  /// What lines and borders enclose.
  struct Chart {
    std::int64_t triangles = 0;
    std::int64_t euler = 0;    // characteristic of the surface cut open along all lines
    std::int64_t corners = 0;  // as often as one comes there from another side
    bool is_part = false;      // the rest is elsewhere
    bool is_gone = false;
    std::vector<std::uint32_t> lines;
  };
  /// A line, or what of a border lies between two corners.
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
    std::vector<std::uint32_t> lines;   // those that begin and end there twice
    std::vector<std::uint32_t> charts;  // as often as they come there
  };

  std::vector<Chart> charts;
  std::vector<Line> lines;
  std::vector<Corner> corners;
};

/// How many triangles are left at least, about: a chart of the shape of a disk keeps two less than
/// it has corners, and the corners stay. One of two corners goes with its last triangle: its lines
/// become one, and where two lines are left there is no corner any more.
std::uint64_t floor_of(SeamGraph graph);

}  // namespace meshfarm
