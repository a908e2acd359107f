// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/piece_bounder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace meshfarm {
namespace {

/// For triangles thinner than this, rounding decides on which side a point is.
constexpr double k_sliver = 1e-10;
constexpr double k_relative_rounding = 0x1p-44;
/// A first guess within this share of the target distance is good enough; measured: 0.1 takes 10 %
/// longer, 0.5 the same time.
constexpr double k_near_enough = 0.25;

/// Pieces shorter than this share of the triangle below them, and longer than this many targets,
/// are cut along its sides. Flat surfaces then need a few pieces per triangle below, however small
/// the target is; halves would have to become as small as the target all along these sides. With
/// larger pieces, or from 16 targets on, CT and CAD with 0.01 % take up to twice the time.
constexpr double k_shorter = 0.5;
constexpr double k_long = 64;
/// Cuts leave at least this share of a side.
constexpr double k_least_cut = 1e-3;

/// The squared distance to the segment's nearest point.
double squared_above(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a;
  const double all = dot(ab, ab);
  const double along = all > 0 ? std::clamp(dot(p - a, ab) / all, 0.0, 1.0) : 0;
  return std::min(squared_length(p - (a + ab * along)), squared_length(p - a));
}

PieceCut in_halves(const CornerPoints& corners) {
  PieceCut cut;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = squared_length(corners[(i + 1) % 3] - corners[i]);
    if (squared > most) {
      most = squared;
      cut.side = i;
    }
  }
  return cut;
}

/// Whether no corner is farther from the plane of `below`.
bool is_flat_over(const CornerPoints& corners, const CornerPoints& below, double most) {
  const Vec3 normal = cross(below[1] - below[0], below[2] - below[0]);
  const double limit = most * length(normal);
  return std::all_of(corners.begin(), corners.end(),
                     [&](Vec3 p) { return std::abs(dot(p - below[0], normal)) <= limit; });
}

/// Where the corners lie on both sides of a side of `below`, seen along its normal: a place above
/// the line of the side that most of the piece reaches across.
std::optional<PieceCut> along_sides(const CornerPoints& corners, const CornerPoints& below) {
  const Vec3 normal = cross(below[1] - below[0], below[2] - below[0]);
  std::optional<PieceCut> cut;
  double farthest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 out = cross(below[(i + 1) % 3] - below[i], normal);
    const double squared = squared_length(out);
    if (!(squared > 0)) continue;
    std::array<double, 3> beyond;
    for (std::size_t k = 0; k < 3; ++k) {
      beyond[k] = dot(corners[k] - below[i], out) / std::sqrt(squared);
    }
    const double reach = std::min(*std::max_element(beyond.begin(), beyond.end()),
                                  -*std::min_element(beyond.begin(), beyond.end()));
    if (!(reach > farthest)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double here = beyond[k], there = beyond[(k + 1) % 3];
      if ((here > 0) == (there > 0)) continue;
      const double share = here / (here - there);
      if (!(share > k_least_cut && share < 1 - k_least_cut)) continue;
      farthest = reach;
      cut = {k, share};
    }
  }
  return cut;
}

}  // namespace

double distance_above(Vec3 p, const CornerPoints& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = cross(ab, ac);
  const double area = dot(normal, normal);
  const double at_b = dot(cross(ap, ac), normal);
  const double at_c = dot(cross(ab, ap), normal);
  double best = HUGE_VAL;
  if (area > 0 && at_b >= 0 && at_c >= 0 && at_b + at_c <= area) {
    best = squared_length(ap - ab * (at_b / area) - ac * (at_c / area));
    if (area > k_sliver * dot(ab, ab) * dot(ac, ac)) return std::sqrt(best);
  }
  best = std::min({best, squared_above(p, a, b), squared_above(p, b, c), squared_above(p, c, a)});
  return std::sqrt(best);
}

double farthest_corner(const CornerPoints& corners, const CornerPoints& triangle, double most) {
  double farthest = 0;
  for (const Vec3 p : corners) {
    farthest = std::max(farthest, distance_above(p, triangle));
    if (farthest > most) return HUGE_VAL;
  }
  return farthest;
}

double rounding_of(const Box& box) {
  if (box.empty()) return 0;
  double greatest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
  }
  return k_relative_rounding * greatest;
}

/// Pieces that are no farther are settled.
double PieceBounder::target() const {
  const double gap = std::max(options_.gap, options_.relative_gap * bounds_.lower);
  return std::max(options_.enough - rounding_, bounds_.lower + gap);
}

/// Tightens the piece's upper bound and the overall lower bound.
bool PieceBounder::is_settled(Piece& piece) {
  const double most = target();
  // Where bounds are returned and not only compared, compute them exactly.
  const double limit = options_.stops_beyond ? most : HUGE_VAL;
  piece.upper = std::min(piece.upper, farthest_from(piece, piece.guess, limit));
  if (piece.upper <= most) return true;
  const auto& [a, b, c] = piece.corners;
  const Vec3 middle = (a + b + c) * (1.0 / 3);
  double radius = 0;
  for (const Vec3 p : piece.corners) radius = std::max(radius, length(p - middle));
  // A piece too large to be settled by its middle only needs a first guess for its parts.
  const double slack = radius < most ? most - radius : k_near_enough * most;
  const double enough = slack * slack;
  const Bvh::Nearest nearest = bvh_.nearest(middle, piece.guess, enough);
  if (nearest.squared > enough) bounds_.lower = std::max(bounds_.lower, std::sqrt(nearest.squared));
  const CornerPoints there = corners_of(to_.positions, to_.triangles[nearest.triangle]);
  piece.upper = std::min(piece.upper, distance_above(middle, there) + radius);
  if (nearest.triangle != piece.guess) {
    piece.upper = std::min(piece.upper, farthest_corner(piece.corners, there, limit));
    piece.guess = nearest.triangle;
  }
  return piece.upper <= target();
}

void PieceBounder::look_at(Piece piece) {
  if (is_settled(piece)) {
    bounds_.upper = std::max(bounds_.upper, piece.upper);
    return;
  }
  open_.push_back(piece);
  std::push_heap(open_.begin(), open_.end());
}

PieceCut PieceBounder::cut_of(const Piece& piece) const {
  const CornerPoints below = corners_of(to_.positions, to_.triangles[piece.guess]);
  const double longest = longest_side(piece.corners);
  if (longest > k_long * target() && longest < k_shorter * longest_side(below) &&
      is_flat_over(piece.corners, below, target())) {
    if (const auto cut = along_sides(piece.corners, below)) return *cut;
  }
  return in_halves(piece.corners);
}

DistanceBounds PieceBounder::bound(const CornerPoints& corners, const HausdorffOptions& options,
                                   std::uint32_t& guess) {
  options_ = options;
  bounds_ = {};
  open_.clear();
  look_at({corners, HUGE_VAL, guess});
  for (std::uint64_t pieces = 1; !open_.empty(); ++pieces) {
    const bool is_beyond = options_.stops_beyond && bounds_.lower > options_.enough;
    if (is_beyond || pieces >= options_.most_pieces || open_.front().upper <= target()) break;
    std::pop_heap(open_.begin(), open_.end());
    const Piece top = open_.back();
    open_.pop_back();
    const auto [side, share] = cut_of(top);
    const Vec3 from = top.corners[side], to = top.corners[(side + 1) % 3];
    const Vec3 opposite = top.corners[(side + 2) % 3], at = from * (1 - share) + to * share;
    look_at({{from, at, opposite}, top.upper, top.guess});
    look_at({{at, to, opposite}, top.upper, top.guess});
    guess = top.guess;
  }
  if (!open_.empty()) bounds_.upper = std::max(bounds_.upper, open_.front().upper);
  const double lower = std::max(0.0, bounds_.lower * (1 - k_relative_rounding) - rounding_);
  return {lower, std::max(lower, bounds_.upper * (1 + k_relative_rounding) + rounding_)};
}

}  // namespace meshfarm
