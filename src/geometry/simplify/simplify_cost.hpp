// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <meshfarm/geometry/vec.hpp>

#include "geometry/simplify/quadric.hpp"

namespace meshfarm {

/// A vertex's quadric for ranking. Float is enough: about the vertex itself nothing is subtracted
/// from large numbers, and an error of 1e-7 of trace x squared length is lost in the ranking's own
/// preference for short edges.
struct FloatQuadric {
  float xx = 0;
  float xy = 0;
  float xz = 0;
  float yy = 0;
  float yz = 0;
  float zz = 0;
  // Padding to two vector registers, so that it lies in one cache line.
  float none0 = 0;
  float none1 = 0;

  FloatQuadric() = default;
  explicit FloatQuadric(const Quadric& q)
      : xx(static_cast<float>(q.xx)),
        xy(static_cast<float>(q.xy)),
        xz(static_cast<float>(q.xz)),
        yy(static_cast<float>(q.yy)),
        yz(static_cast<float>(q.yz)),
        zz(static_cast<float>(q.zz)) {}

  void add(const FloatQuadric& q) {
    xx += q.xx;
    xy += q.xy;
    xz += q.xz;
    yy += q.yy;
    yz += q.yz;
    zz += q.zz;
    none0 += q.none0;
    none1 += q.none1;
  }
};

struct EdgeCost {
  double least = 0;       // of any position, by the ridge or of an end; 0 if lost in rounding
  double ranking = 0;     // orders edges: where planes cost nothing, the short ones come first
  bool is_rough = false;  // too little for float to tell
};

/// Costs of several edges at a time, laid out so that compilers vectorise the loops.
class EdgeCosts {
 public:
  static constexpr std::size_t k_size = 16;

  /// The edge from -half to +half.
  void put(std::size_t i, const FloatQuadric& a, const FloatQuadric& b, const Vec3& half) {
    a_[i] = a;
    b_[i] = b;
    hx_[i] = static_cast<float>(half.x);
    hy_[i] = static_cast<float>(half.y);
    hz_[i] = static_cast<float>(half.z);
  }
  /// With `bounds` a ranking is a lower bound of the cost.
  void compute(bool bounds = false);
  EdgeCost get(std::size_t i) const { return {least_[i], ranking_[i], is_rough(i)}; }

 private:
  using Lane = std::array<float, k_size>;
  void gather();
  void solve();
  void weigh(bool bounds);
  bool is_rough(std::size_t i) const;

  std::array<FloatQuadric, k_size> a_;
  std::array<FloatQuadric, k_size> b_;
  // Sum and difference (b - a) of the two quadrics.
  Lane xx_{}, xy_{}, xz_{}, yy_{}, yz_{}, zz_{};
  Lane dxx_{}, dxy_{}, dxz_{}, dyy_{}, dyz_{}, dzz_{};
  Lane hx_{}, hy_{}, hz_{};
  Lane trace_{};
  Lane cost_{};     // / trace
  Lane squared_{};  // a quarter of the edge's squared length
  std::array<double, k_size> least_{};
  std::array<double, k_size> ranking_{};
};

/// The cost of moving the end with the quadric `other` to the opposite end, whose quadric is not
/// counted.
EdgeCost cost_of_end(const FloatQuadric& other, Vec3 half, bool bounds = false);

// The same, as lower bounds in double, where float is too coarse.
EdgeCost fine_cost(const Quadric& a, const Quadric& b, Vec3 half);
EdgeCost fine_cost_of_end(const Quadric& other, Vec3 half);

}  // namespace meshfarm
