// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/collapse_star.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

constexpr double k_cos_60_squared = 0.25;
constexpr double k_cos_85_squared = 0.0076;
// Minimum squared sine of the angle at the new vertex: angles near 0 or 180 degrees are as good as
// no area.
constexpr double k_least_sine_squared = 1e-6;
// Triangles that are nearly as thin as that already may become four times as thin, down to this,
// and new slivers may be as thin as this.
constexpr double k_least_of_slivers = 1e-12;
// If the normals add up to less than this share of the total area, the star faces all ways, as on a
// pin or a thin tube. Without a limit, nearly twice as many triangles of a dragon cross; with 0.3
// or 0.15, wires have 10 % more error.
constexpr double k_all_ways = 0.5;
// Triangles of ribbons have an angle below 3 degrees. With 1.1, curved hair has 15 to 25 % more
// error; with 6, about as much.
constexpr double k_ribbon_sine_squared = 0.0025;
constexpr double k_least_of_ribbons = 1e-28;  // anything less is rounding noise of no area
constexpr double k_thinner_squared = 1.0 / 16;
// Slivers that a collapse may make have an angle below a quarter of a degree. Each costs this much
// times the fourth power of its longest side: more than nearly flat regions, much less than a
// corner.
constexpr double k_sliver_sine_squared = 1.6e-5;
constexpr double k_cost_of_sliver = 1e-5;
// With 1, spines have up to a quarter more error from the result to the input; with 10, up to 4 %
// less and 1 % more the other way.
constexpr double k_of_protruding = 3;

/// The squared sine of the smallest angle of the triangle x, p, q; 0 if it has no area.
/// `squared_normal`: the squared length of cross(p - x, q - x).
double squared_least_sine(Vec3 x, Vec3 p, Vec3 q, double squared_normal) {
  if (!(squared_normal > 0)) return 0;
  const double a = squared_length(p - x);
  const double b = squared_length(q - x);
  const double c = squared_length(p - q);
  return squared_normal / std::max({a * b, b * c, c * a});
}

/// Whether a triangle that is not a sliver yet becomes one if its end moves to x.
bool becomes_sliver(const StarTriangle& old, Vec3 x) {
  if (squared_least_sine(old.end, old.p, old.q, old.squared_size) < k_sliver_sine_squared)
    return false;
  const double size = squared_length(cross(old.p - x, old.q - x));
  const double sine = squared_least_sine(x, old.p, old.q, size);
  return sine > k_least_of_slivers && sine < k_sliver_sine_squared;
}

}  // namespace

void CollapseStar::sum_planes(EdgeQuadric& quadric) const {
  const auto sum = [](const Pair& pair) { return pair[0] + pair[1]; };
  const Sums& s = sums_;
  quadric.a = quadric.a + Quadric{sum(s.xx), sum(s.xy), sum(s.xz), sum(s.yy), sum(s.yz), sum(s.zz)};
  quadric.b = quadric.b + Vec3{sum(s.bx), sum(s.by), sum(s.bz)};
  quadric.c += sum(s.c);
  quadric.normals = {sum(s.nx), sum(s.ny), sum(s.nz)};
  quadric.height = sum(s.height);
  quadric.twice_area = sum(s.twice_area);
}

/// A sliver of the input may stay one: otherwise nothing around it could ever collapse. Its angle
/// at the old end may have been wide, as every sliver has a wide angle. A needle whose tip is at x
/// and that stands straight on its short side has a normal as good as any.
bool CollapseStar::is_acceptable(const Two& two, int lane, Vec3 x, double cos_squared) const {
  const auto at = [&](const Vec3Pair& a) { return Vec3{a.x[lane], a.y[lane], a.z[lane]}; };
  const Vec3 p = at(two.p);
  const Vec3 q = at(two.q);
  const Vec3 end = at(two.end);
  const Vec3 old_normal = at(two.normal);
  const Vec3 normal = meshfarm::cross(p - x, q - x);
  const double size = squared_length(normal);
  const double old_size = squared_length(old_normal);
  const double turn = meshfarm::dot(normal, old_normal);
  const bool turned = !(turn > 0 && turn * turn >= cos_squared * size * old_size);
  if (turned && old_size > 0) return false;
  const double scale = squared_length(p - x) * squared_length(q - x);
  if (size > k_least_sine_squared * scale) return true;
  const double old_scale = squared_length(p - end) * squared_length(q - end);
  if (old_size > k_least_sine_squared * old_scale) {
    const double old_sine = squared_least_sine(end, p, q, old_size);
    const double sine = squared_least_sine(x, p, q, size);
    return old_sine * k_thinner_squared <= k_least_sine_squared &&
           meshfarm::dot(p - x, q - x) > 0 && sine > k_least_of_slivers &&
           sine >= k_thinner_squared * old_sine;
  }
  const double opposite = squared_length(p - q);
  const double shorter = std::min(squared_length(p - x), squared_length(q - x));
  if (opposite < shorter && size > k_least_sine_squared * opposite * shorter) return true;
  const double thinner = size > k_least_of_slivers * scale ? k_thinner_squared : 1;
  return size * old_scale >= thinner * old_size * scale && (size > 0 || old_size == 0);
}

/// Whether a triangle that has turned much faces against the new star as a whole, weighted by area.
/// The normal of a sliver may turn by 60 degrees again and again, and so fold over in the end. At
/// the tip of a thin pin some triangles always face against the rest: there, one counts only if it
/// did not before.
bool CollapseStar::is_folded(std::uint32_t first, std::uint32_t kept, Vec3 x,
                             const TurnLimits& limits) const {
  const auto at = [&](const Vec3Pair& a, std::uint32_t i) {
    return Vec3{a.x[i % 2], a.y[i % 2], a.z[i % 2]};
  };
  const auto normal_at = [&](std::uint32_t i) {
    const Two& two = pairs_[first + i / 2];
    return meshfarm::cross(at(two.p, i) - x, at(two.q, i) - x);
  };
  Vec3 all{};
  Vec3 old_all{};
  double old_size = 0;
  for (std::uint32_t i = 0; i < kept; ++i) {
    all = all + normal_at(i);
    const Vec3 old_normal = at(pairs_[first + i / 2].normal, i);
    old_all = old_all + old_normal;
    old_size += length(old_normal);
  }
  const bool faces_all_ways = length(old_all) < k_all_ways * old_size;
  for (std::uint32_t i = 0; i < kept; ++i) {
    const Two& two = pairs_[first + i / 2];
    const Vec3 normal = normal_at(i);
    const Vec3 old_normal = at(two.normal, i);
    const double turn = meshfarm::dot(normal, old_normal);
    const double sizes = squared_length(normal) * two.squared_size[i % 2];
    if (turn * turn >= limits.cos_squared * sizes || meshfarm::dot(normal, all) > 0) continue;
    if (limits.turn == Turn::sliver && becomes_sliver(triangle(2 * first + i), x)) continue;
    if (!faces_all_ways || meshfarm::dot(old_normal, old_all) > 0) return true;
  }
  return false;
}

/// Where a ribbon bends, one side becomes straight before the other, and the triangles between them
/// stand across until the other does, too. The area that they add until then is no loss.
std::optional<double> CollapseStar::lost_area_of_ribbon(std::uint32_t first, std::uint32_t kept,
                                                        Vec3 x) const {
  double twice_lost = sums_.twice_area[0] + sums_.twice_area[1];
  for (std::uint32_t i = 0; i < kept; ++i) {
    const StarTriangle old = triangle(2 * first + i);
    const double old_sine = squared_least_sine(old.end, old.p, old.q, old.squared_size);
    if (old_sine > k_ribbon_sine_squared) return {};
    const double size = squared_length(meshfarm::cross(old.p - x, old.q - x));
    const double sine = squared_least_sine(x, old.p, old.q, size);
    if (!(sine > k_least_of_ribbons && sine >= k_thinner_squared * old_sine)) return {};
    twice_lost -= std::sqrt(size);
  }
  return 0.5 * std::max(twice_lost, 0.0);
}

double CollapseStar::cost_of_protruding(std::uint32_t first, std::uint32_t kept, Vec3 x,
                                        double lost) const {
  const double squared_half = squared_length(half_);
  const double at = meshfarm::dot(x, half_);
  if (lost >= 0 || !(std::abs(at) > squared_half)) return 0;
  const Vec3 out = half_ * (at > 0 ? 1.0 : -1.0);
  double least = std::abs(at) - squared_half;
  for (std::uint32_t i = 0; i < kept && least > 0; ++i) {
    const StarTriangle t = triangle(2 * first + i);
    const double beyond = std::max(meshfarm::dot(t.p, out), meshfarm::dot(t.q, out));
    least = std::min(least, std::abs(at) - beyond);
  }
  return least > 0 ? k_of_protruding * -lost * least * least / squared_half : 0;
}

double CollapseStar::cost_of_slivers(std::uint32_t first, std::uint32_t kept, Vec3 x) const {
  double cost = 0;
  for (std::uint32_t i = 0; i < kept; ++i) {
    const StarTriangle old = triangle(2 * first + i);
    if (!becomes_sliver(old, x)) continue;
    const double longest = std::max(
        {squared_length(old.p - x), squared_length(old.q - x), squared_length(old.p - old.q)});
    cost += k_cost_of_sliver * longest * longest;
  }
  return cost;
}

std::optional<double> CollapseStar::lost_area_from(std::uint32_t first, std::uint32_t kept, Vec3 x,
                                                   const TurnLimits& limits) const {
  if (limits.turn == Turn::ribbon) return lost_area_of_ribbon(first, kept, x);
  const double cos_squared = limits.turn == Turn::far ? k_cos_85_squared : k_cos_60_squared;
  const auto is_spoilt = [&](std::uint32_t i) {
    if (is_acceptable(pairs_[first + i / 2], static_cast<int>(i % 2), x, cos_squared)) return false;
    return limits.turn != Turn::sliver || !becomes_sliver(triangle(2 * first + i), x);
  };
  Pair twice_lost = sums_.twice_area;
  Mask steep{};
  Mask turning{};
  const Vec3Pair to = from(x);
  for (std::uint32_t i = 0; i < kept; i += 2) {
    const Two& two = pairs_[first + i / 2];
    const Vec3Pair p = minus(two.p, to);
    const Vec3Pair q = minus(two.q, to);
    const Vec3Pair normal = cross(p, q);
    Pair size;
    Pair turned;
    Pair squared_p;
    Pair squared_q;
    dot(normal, normal, size);
    dot(normal, two.normal, turned);
    dot(p, p, squared_p);
    dot(q, q, squared_q);
    const Pair sizes = size * two.squared_size;
    steep |= turned * turned < k_cos_30_squared * sizes;
    turning |= turned * turned < limits.cos_squared * sizes;
    const Mask good = (turned > 0) & (turned * turned >= cos_squared * sizes) &
                      (size > k_least_sine_squared * (squared_p * squared_q));
    if ((good[0] & good[1]) == 0) {
      if (good[0] == 0 && is_spoilt(i)) return {};
      // Beyond the last triangle there may be none: p == q makes it neither good nor an area.
      if (good[1] == 0 && i + 1 < kept && is_spoilt(i + 1)) return {};
    }
    Pair length;
    root(size, length);
    twice_lost -= length;
  }
  if (limits.turn == Turn::narrow && (steep[0] | steep[1]) != 0) return {};
  if ((turning[0] | turning[1]) != 0 && is_folded(first, kept, x, limits)) return {};
  return 0.5 * (twice_lost[0] + twice_lost[1]);
}

}  // namespace meshfarm
