// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/wedge_star.hpp"

#include <algorithm>
#include <cmath>

namespace meshfarm {
namespace {

// The steepest slope of texture coordinates, as a length over a length, that counts in full:
// steeper ones count no more than this.
constexpr double k_steepest = 1;

// Minimum squared sine of the angle between two sides on the texture: smaller ones are as good as
// no area.
constexpr double k_least_wedge_sine_squared = 1e-6;
// Texture coordinates are rounded: the area that this leaves uncertain, as a share of their size
// times that of the sides.
constexpr double k_rounding = 0x1p-22;

/// A triangle on the texture.
struct FlatPoint {
  double area = 0;  // signed, twice; 0 where rounding may have made it
  double scale = 0;

  FlatPoint(const Uv& a, const Uv& b, const Uv& c) {
    const double bu = double{b[0]} - a[0];
    const double bv = double{b[1]} - a[1];
    const double cu = double{c[0]} - a[0];
    const double cv = double{c[1]} - a[1];
    const double size = std::max(std::abs(double{a[0]}), std::abs(double{a[1]}));
    const double sides = std::abs(bu) + std::abs(bv) + std::abs(cu) + std::abs(cv);
    const double twice = bu * cv - bv * cu;
    if (std::abs(twice) > k_rounding * size * sides) area = twice;
    scale = (bu * bu + bv * bv) * (cu * cu + cv * cv);
  }
};

/// Whether a triangle whose first corner moves is not turned over on the texture and keeps some
/// area there, if it had any.
bool keeps_shape(const LinearUv::Corners& c, const Uv& now) {
  const FlatPoint was(c.at_end, c.at_p, c.at_q);
  if (was.area == 0 || !std::isfinite(was.area)) return true;
  const FlatPoint is(now, c.at_p, c.at_q);
  if (!(is.area * was.area > 0)) return false;
  const double squared = is.area * is.area;
  return squared > k_least_wedge_sine_squared * is.scale ||
         squared * was.scale >= was.area * was.area * is.scale;
}

double squared(const std::array<double, 2>& a) {
  return a[0] * a[0] + a[1] * a[1];
}

}  // namespace

void merge_wedges(std::span<const WedgeMerge> merges, std::span<const CornerId> at_a,
                  std::span<const CornerId> at_b, std::span<CornerUvs> uvs) {
  const auto rewrite = [&](std::span<const CornerId> ids, Uv WedgeMerge::*was) {
    for (const CornerId id : ids) {
      Uv& uv = uv_of(uvs, id);
      const auto merge = std::find_if(merges.begin(), merges.end(),
                                      [&](const WedgeMerge& m) { return is_same(m.*was, uv); });
      if (merge != merges.end()) uv = merge->now;
    }
  };
  rewrite(at_a, &WedgeMerge::at_a);
  rewrite(at_b, &WedgeMerge::at_b);
}

LinearUv LinearUv::of(const Corners& c, const Uv& base, double scale) {
  LinearUv made;
  const Vec3 to_p = c.p - c.end;
  const Vec3 to_q = c.q - c.end;
  const Vec3 normal = cross(to_p, to_q);
  const double size = squared_length(normal);
  if (!(size > 0 && std::isfinite(size))) return made;
  double steepness = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double rise_p = double{c.at_p[i]} - c.at_end[i];
    const double rise_q = double{c.at_q[i]} - c.at_end[i];
    made.slope[i] = cross(normal, to_p * rise_q - to_q * rise_p) * (1 / size);
    made.at_origin[i] = double{c.at_end[i]} - base[i] - dot(made.slope[i], c.end);
    steepness += squared_length(made.slope[i]);
  }
  if (!std::isfinite(steepness) || !std::isfinite(squared(made.at_origin))) return {};
  steepness *= scale * scale;
  made.weight = 0.5 * std::sqrt(size);
  if (steepness > k_steepest * k_steepest) made.weight *= k_steepest * k_steepest / steepness;
  return made;
}

void LinearUvSums::add(const LinearUv& uv) {
  if (!(uv.weight > 0)) return;
  weight += uv.weight;
  for (std::size_t i = 0; i < 2; ++i) {
    slopes[i] = slopes[i] + uv.slope[i] * uv.weight;
    heights[i] += uv.at_origin[i] * uv.weight;
    squares.add(uv.slope[i], uv.weight);
    products = products + uv.slope[i] * (uv.at_origin[i] * uv.weight);
    squared_heights += uv.at_origin[i] * uv.at_origin[i] * uv.weight;
  }
}

Quadric LinearUvSums::quadric() const {
  Quadric made = squares;
  if (!(weight > 0)) return made;
  for (const Vec3& slope : slopes) made.add(slope, -1 / weight);
  return made;
}

void LinearUvSums::add_to(EdgeQuadric& edge, double scale) const {
  if (!(weight > 0) || !(scale > 0)) return;
  const double squared_scale = scale * scale;
  edge.a = edge.a + quadric() * squared_scale;
  Vec3 linear = products;
  for (std::size_t i = 0; i < 2; ++i) linear = linear - slopes[i] * (heights[i] / weight);
  edge.b = edge.b - linear * squared_scale;
  edge.c += squared_scale * std::max(0.0, squared_heights - squared(heights) / weight);
}

std::array<double, 2> LinearUvSums::mean_at(Vec3 x) const {
  if (!(weight > 0)) return {NAN, NAN};
  return {(heights[0] + dot(slopes[0], x)) / weight, (heights[1] + dot(slopes[1], x)) / weight};
}

void WedgeStar::list(const CollapseState& state, std::uint32_t a, std::uint32_t b, Vec3 middle) {
  middle_ = middle;
  scale_ = state.uv_scale;
  cost_ = 0;
  kept_.clear();
  shared_.clear();
  sides_.clear();
  merges_.clear();
  list_end(state, a, b, false);
  list_end(state, b, a, true);
  is_even_ = !sides_.empty();
  if (!is_even_) return;
  base_ = sides_[0].at_a;
  for (const Side& s : sides_) {
    is_even_ = is_even_ && is_same(s.at_a, sides_[0].at_a) && is_same(s.at_b, sides_[0].at_b);
  }
  for (const Facet& f : kept_) {
    is_even_ = is_even_ && is_same(f.corners.at_end, f.at_b ? sides_[0].at_b : sides_[0].at_a);
  }
}

void WedgeStar::list_end(const CollapseState& state, std::uint32_t end, std::uint32_t other,
                         bool at_b) {
  const CornerFan fan = state.adjacency->fan_at(end);
  const std::span<const CornerUvs> uvs = state.adjacency->columns().uvs;
  const Vec3 at = state.positions[end] - middle_;
  for (std::size_t i = 0; i < fan.corners.size(); ++i) {
    const std::uint32_t next = state.target[fan.corners[i].next];
    const std::uint32_t prev = state.target[fan.corners[i].prev];
    if (next == prev) continue;  // gone in this pass
    const bool is_shared = next == other || prev == other;
    if (is_shared && at_b) continue;
    const CornerId id = fan.ids[i];
    const Facet facet{{at, state.positions[next] - middle_, state.positions[prev] - middle_,
                       uv_of(uvs, id), uv_of(uvs, next_corner(id)), uv_of(uvs, prev_corner(id))},
                      at_b};
    (is_shared ? shared_ : kept_).push_back(facet);
    if (!is_shared) continue;
    const auto& corners = facet.corners;
    sides_.push_back({corners.at_end, next == other ? corners.at_p : corners.at_q});
  }
}

void WedgeStar::add_to(EdgeQuadric& edge) {
  sums_ = {};
  for (const auto* facets : {&shared_, &kept_}) {
    for (const Facet& f : *facets) sums_.add(LinearUv::of(f.corners, base_, scale_));
  }
  sums_.add_to(edge, scale_);
}

bool WedgeStar::place(Vec3 x) {
  merges_.clear();
  const auto [u, v] = sums_.mean_at(x);
  const Uv now{static_cast<float>(base_[0] + u), static_cast<float>(base_[1] + v)};
  if (!std::isfinite(now[0]) || !std::isfinite(now[1])) return false;
  for (const Facet& f : kept_) {
    if (!keeps_shape(f.corners, now)) return false;
  }
  merges_.push_back({sides_[0].at_a, sides_[0].at_b, now});
  return true;
}

/// Whether sides that start at the same place on the texture also end at the same place.
bool WedgeStar::sides_agree(bool at_b) const {
  return std::all_of(sides_.begin(), sides_.end(), [&](const Side& s) {
    const Side& first = *side_of(at_b ? s.at_b : s.at_a, at_b);
    return is_same(at_b ? s.at_a : s.at_b, at_b ? first.at_a : first.at_b);
  });
}

const WedgeStar::Side* WedgeStar::side_of(const Uv& wedge, bool at_b) const {
  const auto side = std::find_if(sides_.begin(), sides_.end(), [&](const Side& s) {
    return is_same(at_b ? s.at_b : s.at_a, wedge);
  });
  return side != sides_.end() ? &*side : nullptr;
}

bool WedgeStar::place_at(End end, Vec3 x) {
  merges_.clear();
  cost_ = 0;
  const bool moves_b = end == End::a;
  if (!sides_agree(moves_b)) return false;
  for (const Facet& f : kept_) {
    if (f.at_b != moves_b) continue;
    const Side* const side = side_of(f.corners.at_end, moves_b);
    if (side == nullptr) return false;
    const Uv& now = moves_b ? side->at_a : side->at_b;
    if (!keeps_shape(f.corners, now)) return false;
    if (!(scale_ > 0)) continue;
    const LinearUv uv = LinearUv::of(f.corners, now, scale_);
    if (uv.weight > 0) cost_ += scale_ * scale_ * uv.weight * squared(uv.at(x));
  }
  for (const Side& s : sides_) merges_.push_back({s.at_a, s.at_b, moves_b ? s.at_a : s.at_b});
  return true;
}

}  // namespace meshfarm
