// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_cost.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace meshfarm {
namespace {

// Cost of length, per trace x squared half length, so that flat regions do not collapse into fans
// in order of their indices. 1e-3 costs 15 % of the error at 10 % of the triangles; 4e-6 lets
// nearly flat regions go before flat ones, with three times the error on a surface that is half
// flat. Less is lost in the rounding of floats.
constexpr double k_length_share = 2e-7;

// The same where a ranking is a lower bound, and flat regions are told apart exactly later.
constexpr double k_least_length_share = 1e-12;

// Costs below this share are known to a tenth at best.
constexpr double k_rough_share = 10 * k_length_share;

// Of the trace, as in EdgeQuadric::best.
constexpr float k_ridge = 1e-5F;

double least_cost(double cost, double trace, double squared_half) {
  return trace * std::max(0.0, cost - k_length_share * squared_half);
}

double ranking_cost(double cost, double trace, double squared_half) {
  return trace * (std::max(0.0, cost) + k_length_share * squared_half);
}

}  // namespace

void EdgeCosts::compute(bool bounds) {
  gather();
  solve();
  weigh(bounds);
}

void EdgeCosts::gather() {
  for (std::size_t i = 0; i < k_size; ++i) {
    xx_[i] = a_[i].xx + b_[i].xx;
    xy_[i] = a_[i].xy + b_[i].xy;
    xz_[i] = a_[i].xz + b_[i].xz;
    yy_[i] = a_[i].yy + b_[i].yy;
    yz_[i] = a_[i].yz + b_[i].yz;
    zz_[i] = a_[i].zz + b_[i].zz;
    dxx_[i] = b_[i].xx - a_[i].xx;
    dxy_[i] = b_[i].xy - a_[i].xy;
    dxz_[i] = b_[i].xz - a_[i].xz;
    dyy_[i] = b_[i].yy - a_[i].yy;
    dyz_[i] = b_[i].yz - a_[i].yz;
    dzz_[i] = b_[i].zz - a_[i].zz;
  }
}

/// With A x = b solved by A = L D L', the least cost is c - b'x = c - sum of (inv(L) b)^2 / D. The
/// ridge in A makes that a little more for positions far from the edge.
void EdgeCosts::solve() {
  for (std::size_t i = 0; i < k_size; ++i) {
    const float trace = xx_[i] + yy_[i] + zz_[i];
    // Adding FLT_MIN avoids a division by zero, without a branch, where there is no area.
    const float scale = 1 / (trace + FLT_MIN);
    const float hx = hx_[i];
    const float hy = hy_[i];
    const float hz = hz_[i];
    const float ax = xx_[i] * hx + xy_[i] * hy + xz_[i] * hz;
    const float ay = xy_[i] * hx + yy_[i] * hy + yz_[i] * hz;
    const float az = xz_[i] * hx + yz_[i] * hy + zz_[i] * hz;
    const float bx = (dxx_[i] * hx + dxy_[i] * hy + dxz_[i] * hz) * scale;
    const float by = (dxy_[i] * hx + dyy_[i] * hy + dyz_[i] * hz) * scale;
    const float bz = (dxz_[i] * hx + dyz_[i] * hy + dzz_[i] * hz) * scale;
    const float xy = xy_[i] * scale;
    const float xz = xz_[i] * scale;
    const float inverse0 = 1 / (xx_[i] * scale + k_ridge);
    const float l1 = xy * inverse0;
    const float l2 = xz * inverse0;
    const float inverse1 = 1 / (yy_[i] * scale + k_ridge - l1 * xy);
    const float m = yz_[i] * scale - l1 * xz;
    const float l3 = m * inverse1;
    const float inverse2 = 1 / (zz_[i] * scale + k_ridge - l2 * xz - l3 * m);
    const float y1 = by - l1 * bx;
    const float y2 = bz - l2 * bx - l3 * y1;
    const float saved = bx * bx * inverse0 + y1 * y1 * inverse1 + y2 * y2 * inverse2;
    trace_[i] = trace;
    // Or the cost of one of the ends, where the ridge counts nothing.
    const float sum = (ax * hx + ay * hy + az * hz) * scale;
    const float difference = std::abs(bx * hx + by * hy + bz * hz);
    cost_[i] = std::min(sum - saved, 2 * (sum - difference));
    squared_[i] = hx * hx + hy * hy + hz * hz;
  }
}

/// In double, as float lacks the range for an area times a squared distance.
void EdgeCosts::weigh(bool bounds) {
  for (std::size_t i = 0; i < k_size; ++i) {
    least_[i] = least_cost(cost_[i], trace_[i], squared_[i]);
    ranking_[i] = ranking_cost(cost_[i], trace_[i], squared_[i]);
  }
  if (!bounds) return;
  for (std::size_t i = 0; i < k_size; ++i) {
    ranking_[i] = least_[i] + k_least_length_share * trace_[i] * squared_[i];
  }
}

bool EdgeCosts::is_rough(std::size_t i) const {
  return cost_[i] < k_rough_share * squared_[i];
}

EdgeCost cost_of_end(const FloatQuadric& other, Vec3 half, bool bounds) {
  const FloatQuadric& q = other;
  const Vec3 moved{q.xx * half.x + q.xy * half.y + q.xz * half.z,
                   q.xy * half.x + q.yy * half.y + q.yz * half.z,
                   q.xz * half.x + q.yz * half.y + q.zz * half.z};
  const double trace = static_cast<double>(q.xx) + q.yy + q.zz;
  if (!(trace > 0)) return {};
  const double cost = 4 * dot(moved, half) / trace;
  const double squared = squared_length(half);
  const double least = least_cost(cost, trace, squared);
  const bool is_rough = cost < k_rough_share * squared;
  if (bounds) return {least, least + k_least_length_share * trace * squared, is_rough};
  return {least, ranking_cost(cost, trace, squared), is_rough};
}

EdgeCost fine_cost(const Quadric& a, const Quadric& b, Vec3 half) {
  EdgeQuadric quadric;
  quadric.squared_length = 4 * squared_length(half);
  quadric.add(a, half * -1.0);
  quadric.add(b, half);
  const double least =
      std::min({quadric.cost(quadric.cheapest()), quadric.cost(half * -1.0), quadric.cost(half)});
  return {least, least + k_least_length_share * quadric.a.trace() * squared_length(half)};
}

EdgeCost fine_cost_of_end(const Quadric& other, Vec3 half) {
  const double least = 4 * dot(other * half, half);
  return {least, least + k_least_length_share * other.trace() * squared_length(half)};
}

}  // namespace meshfarm
