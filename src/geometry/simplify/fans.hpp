// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {

/// Splits the triangles at a vertex into fans: Gueziec, Taubin, Lazarus, Horn, "Cutting and
/// Stitching: Converting Sets of Polygons to Manifold Surfaces", IEEE TVCG 2001.
///
/// Triangles that share an edge of two triangles are of one fan. Where three or more meet in an
/// edge, a chain of triangles that begins and ends there, with its ends facing alike, closes on
/// itself and is a fan of its own; other chains that meet in such an edge belong together.
class FanSplitter {
 public:
  /// Numbers the fans from 0 in the order of their first corner, and returns how many there are.
  std::uint32_t split(std::span<const Corner> corners);
  /// The fan of each corner.
  std::span<const std::uint32_t> fans() const { return fan_; }
  /// Whether each fan goes once round, has two ends, or neither.
  enum class Kind : std::uint8_t { closed, open, complex };
  Kind kind() const { return kind_; }
  /// Whether some edge's two triangles face opposite ways.
  bool has_turned() const { return turned_; }

 private:
  struct End {
    std::uint32_t neighbour;
    std::uint32_t corner;
    bool begins;  // the corner begins there, with its next vertex
  };
  std::uint32_t root(std::uint32_t corner);
  void join(std::uint32_t one, std::uint32_t other);

  std::vector<End> ends_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> fan_;
  Kind kind_ = Kind::closed;
  bool turned_ = false;
};

}  // namespace meshfarm
