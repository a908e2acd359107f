// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

using CornerPoints = std::array<Vec3, 3>;

inline CornerPoints corners_of(std::span<const Vec3> positions, const Triangle& t) {
  return {positions[t[0]], positions[t[1]], positions[t[2]]};
}

inline double longest_side(const CornerPoints& corners) {
  const auto& [a, b, c] = corners;
  return std::sqrt(std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)}));
}

/// An upper bound of the distance of `p` to the triangle, up to the rounding of a few operations on
/// coordinates: the distance to some point of the triangle, however thin it is.
double distance_above(Vec3 p, const CornerPoints& triangle);

/// The greatest of the corners' distances to the triangle; infinite if that exceeds `most`. As a
/// triangle is convex, no point between the corners is farther.
double farthest_corner(const CornerPoints& corners, const CornerPoints& triangle, double most);

/// The rounding error of distances between points with such coordinates.
double rounding_of(const Box& box);

/// Where to cut a piece in two: a place on the side from this corner to the next.
struct PieceCut {
  std::size_t side = 0;
  double share = 0.5;
};

/// Bounds the distance of the farthest point of a triangle to a surface, by pieces: undecided
/// pieces are cut in two.
class PieceBounder {
 public:
  /// Both must outlive it. `rounding`: of all coordinates (rounding_of).
  PieceBounder(const Mesh& to, const Bvh& bvh, double rounding)
      : to_(to), bvh_(bvh), rounding_(rounding) {}

  /// `guess`: a triangle near the corners; updated. The options' threads are ignored.
  DistanceBounds bound(const CornerPoints& corners, const HausdorffOptions& options,
                       std::uint32_t& guess);

 private:
  struct Piece {
    CornerPoints corners;
    double upper;
    std::uint32_t guess;
    bool operator<(const Piece& other) const { return upper < other.upper; }
  };

  double target() const;
  void look_at(Piece piece);
  bool is_settled(Piece& piece);
  PieceCut cut_of(const Piece& piece) const;
  double farthest_from(const Piece& piece, std::uint32_t triangle, double most) const {
    return farthest_corner(piece.corners, corners_of(to_.positions, to_.triangles[triangle]), most);
  }

  const Mesh& to_;
  const Bvh& bvh_;
  double rounding_;
  HausdorffOptions options_;
  DistanceBounds bounds_;    // without rounding; `upper`: of settled pieces
  std::vector<Piece> open_;  // a heap: the piece that may be farthest is on top
};

}  // namespace meshfarm
