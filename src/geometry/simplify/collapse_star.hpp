// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <meshfarm/geometry/vec.hpp>

#include "geometry/simplify/quadric.hpp"
#include "geometry/simplify/star_triangle.hpp"

namespace meshfarm {

/// How far a collapse may turn a triangle: by 60 degrees; by 30; by 85; in any way, where all are
/// as thin as those of a ribbon; or by 60, but in any way if it becomes a sliver.
enum class Turn : std::uint8_t { wide, narrow, far, ribbon, sliver };

/// Cost factor for turning a triangle far. With 1, a CAD town has 4.7 times the error at 0.3 %;
/// with 4 or 8, plates keep more of their small holes.
inline constexpr double k_loss_of_far_turn = 2;

/// The triangles around one edge, relative to its middle, two at a time in vector registers. The
/// types are extensions of GNU C++, which clang has too: neither compiler vectorises loops over
/// two.
class CollapseStar {
 public:
  static constexpr std::uint32_t k_capacity = 256;
  static constexpr double k_cos_30_squared = 0.75;
  static constexpr double k_cos_15_squared = 0.933;

  using Pair = double __attribute__((vector_size(16)));
  using Mask = std::int64_t __attribute__((vector_size(16)));  // all bits of a lane or none

  /// Two triangles at the edge, without the end that they are at. p == q means no triangle.
  struct TwoTriangles {
    const Vec3& p0;
    const Vec3& q0;
    const Vec3& p1;
    const Vec3& q1;
  };

  /// The edge from middle - half to middle + half.
  void clear(Vec3 middle, Vec3 half) {
    middle_ = middle;
    half_ = half;
    size_ = 0;
    sums_ = Sums{};
  }
  /// For lost_area(), the two that both ends share come first. `sides` are the ends that the
  /// triangles are at: -1 or 1.
  void add(const TwoTriangles& triangles, const Pair& sides);

  /// Pairs of triangles that were added.
  std::uint32_t pairs() const { return size_; }

  /// The triangle in this place; without area if it is the unused second place of a pair.
  StarTriangle triangle(std::uint32_t place) const;

  /// Adds the planes, and the sums needed to keep the volume.
  void sum_planes(EdgeQuadric& quadric) const;

  /// The area that is lost if both ends move to x; nothing if that spoils the shape of one of the
  /// `kept` triangles after the shared ones.
  std::optional<double> lost_area(std::uint32_t kept, Vec3 x, Turn turn = Turn::wide) const {
    return lost_area_from(1, kept, x, {turn, k_cos_15_squared});
  }
  struct TurnLimits {
    Turn turn = Turn::wide;
    double cos_squared = k_cos_30_squared;  // beyond this, check whether a triangle folds
  };
  /// The same, with the kept triangles beginning at pair `first`.
  std::optional<double> lost_area_from(std::uint32_t first, std::uint32_t kept, Vec3 x,
                                       const TurnLimits& limits) const;
  /// The least cost of gained area (`lost` below 0) where x lies beyond everything around the edge:
  /// at the tip of a spike, where that area is narrow and long.
  double cost_of_protruding(std::uint32_t first, std::uint32_t kept, Vec3 x, double lost) const;
  /// The extra cost of Turn::sliver.
  double cost_of_slivers(std::uint32_t first, std::uint32_t kept, Vec3 x) const;

 private:
  struct Vec3Pair {
    Pair x, y, z;
  };
  struct Two {
    Vec3Pair p, q, end;
    Vec3Pair normal;  // twice the area long
    Pair squared_size;
  };
  struct Sums {
    Pair xx, xy, xz, yy, yz, zz, bx, by, bz, c, twice_area;
    Pair nx, ny, nz, height;  // of the normals, twice the areas long
  };

  static Vec3Pair from(Vec3 a) { return {Pair{a.x, a.x}, Pair{a.y, a.y}, Pair{a.z, a.z}}; }
  static Vec3Pair minus(const Vec3Pair& a, const Vec3Pair& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  static Vec3Pair cross(const Vec3Pair& a, const Vec3Pair& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  static void dot(const Vec3Pair& a, const Vec3Pair& b, Pair& result) {
    result = a.x * b.x + a.y * b.y + a.z * b.z;
  }
  static void root(const Pair& a, Pair& result) { result = Pair{std::sqrt(a[0]), std::sqrt(a[1])}; }
  void add_planes(const Two& two);
  bool is_folded(std::uint32_t first, std::uint32_t kept, Vec3 x, const TurnLimits& limits) const;
  std::optional<double> lost_area_of_ribbon(std::uint32_t first, std::uint32_t kept, Vec3 x) const;
  bool is_acceptable(const Two& two, int lane, Vec3 x, double cos_squared) const;

  Vec3 middle_;
  Vec3 half_;
  std::uint32_t size_ = 0;  // of pairs_
  Sums sums_{};
  std::array<Two, k_capacity / 2 + 2> pairs_;
};

inline void CollapseStar::add(const TwoTriangles& t, const Pair& sides) {
  Two& two = pairs_[size_++];
  const Vec3Pair middle = from(middle_);
  two.p = minus({Pair{t.p0.x, t.p1.x}, Pair{t.p0.y, t.p1.y}, Pair{t.p0.z, t.p1.z}}, middle);
  two.q = minus({Pair{t.q0.x, t.q1.x}, Pair{t.q0.y, t.q1.y}, Pair{t.q0.z, t.q1.z}}, middle);
  two.end = {half_.x * sides, half_.y * sides, half_.z * sides};
  two.normal = cross(minus(two.p, two.end), minus(two.q, two.end));
  dot(two.normal, two.normal, two.squared_size);
  add_planes(two);
}

inline StarTriangle CollapseStar::triangle(std::uint32_t place) const {
  const Two& two = pairs_[place / 2];
  const std::uint32_t lane = place % 2;
  const auto at = [lane](const Vec3Pair& a) { return Vec3{a.x[lane], a.y[lane], a.z[lane]}; };
  return {at(two.end), at(two.p), at(two.q), at(two.normal), two.squared_size[lane]};
}

inline void CollapseStar::add_planes(const Two& two) {
  Pair length;
  root(two.squared_size, length);
  const Mask some = length > 0;
  const Pair weight = reinterpret_cast<Pair>(reinterpret_cast<Mask>(0.5 / length) & some);
  const Vec3Pair n = two.normal;
  Pair height;
  dot(n, two.end, height);
  const Pair wx = n.x * weight;
  const Pair wy = n.y * weight;
  const Pair wh = height * weight;
  sums_.xx += wx * n.x;
  sums_.xy += wx * n.y;
  sums_.xz += wx * n.z;
  sums_.yy += wy * n.y;
  sums_.yz += wy * n.z;
  sums_.zz += n.z * weight * n.z;
  sums_.bx += n.x * wh;
  sums_.by += n.y * wh;
  sums_.bz += n.z * wh;
  sums_.c += wh * height;
  sums_.twice_area += length;
  sums_.nx += n.x;
  sums_.ny += n.y;
  sums_.nz += n.z;
  sums_.height += height;
}

}  // namespace meshfarm
