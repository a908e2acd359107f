// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vec.hpp>

#include "geometry/simplify/quadric.hpp"
#include "geometry/simplify/star_triangle.hpp"

namespace meshfarm {

/// What the appearances around one edge, or one vertex, add to its quadric (Hoppe 1999). A triangle
/// interpolates those of its corners linearly, and so predicts an appearance for any point, inside
/// it or not. The merged vertex gets the mean of the predictions of all triangles, weighted by
/// area. Deviations from the mean cost area x squared difference, in units of length. The quadric
/// is memoryless like that of the planes: it is made from the mesh as it is.
class AppearanceStar {
 public:
  struct Values {
    const Appearance& end;
    const Appearance& p;
    const Appearance& q;
  };

  void clear(const AppearanceScale& scale);
  void add(const StarTriangle& triangle, const Values& values);

  void add_to(EdgeQuadric& edge) const;
  /// The same without linear and constant terms: for the star of one vertex, about the vertex.
  Quadric quadric() const;
  /// The appearance of the merged vertex at x.
  Appearance at(Vec3 x) const;

 private:
  /// The four numbers of an appearance: a vector type of GNU C++, which clang has, too. Float is
  /// enough, as numbers are relative to those of one appearance.
  using Four = float __attribute__((vector_size(16)));

  static constexpr double k_range = 65535;
  // Differences of at most one of 256 levels are not visible, and are what rounding to 8 bits
  // makes. In fine meshes they would cost more than the shape.
  static constexpr float k_unseen = 257;

  static Four numbers(const Appearance& appearance);
  Four seen(const Four& difference) const;
  static bool is_zero(const Four& a, const Four& b, const Four& c);
  static float sum(const Four& four);

  float unit_ = 0;      // of an appearance's numbers
  float steepest_ = 0;  // AppearanceScale::steepest
  bool is_empty_ = true;
  bool is_even_ = true;  // all are equal so far
  Appearance base_{};    // numbers are relative to this
  Four base_numbers_{};
  // Sums, weighted by area: of the gradients, their products, and the predictions for the origin.
  double area_ = 0;
  Four gx_{}, gy_{}, gz_{}, height_{};
  Four xx_{}, xy_{}, xz_{}, yy_{}, yz_{}, zz_{};
  Four hx_{}, hy_{}, hz_{}, hh_{};
};

/// Member by member: compilers turn clearing the whole into a loop that takes as long as a
/// triangle.
inline void AppearanceStar::clear(const AppearanceScale& scale) {
  unit_ = static_cast<float>(scale.length * (1 / k_range));
  steepest_ = static_cast<float>(scale.steepest);
  is_empty_ = true;
  is_even_ = true;
  base_ = {};
  area_ = 0;
  gx_ = gy_ = gz_ = height_ = Four{};
  xx_ = xy_ = xz_ = yy_ = yz_ = zz_ = Four{};
  hx_ = hy_ = hz_ = hh_ = Four{};
}

inline AppearanceStar::Four AppearanceStar::numbers(const Appearance& appearance) {
  using Numbers = std::uint16_t __attribute__((vector_size(8)));
  using Wide = std::int32_t __attribute__((vector_size(16)));
  return __builtin_convertvector(__builtin_convertvector(std::bit_cast<Numbers>(appearance), Wide),
                                 Four);
}

/// The visible part of a difference, in units of length.
inline AppearanceStar::Four AppearanceStar::seen(const Four& difference) const {
  const Four most = {k_unseen, k_unseen, k_unseen, k_unseen};
  const Four at_most = difference < most ? difference : most;
  const Four unseen = at_most > -most ? at_most : -most;
  return (difference - unseen) * unit_;
}

inline bool AppearanceStar::is_zero(const Four& a, const Four& b, const Four& c) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  const Bits bits = std::bit_cast<Bits>(a) | std::bit_cast<Bits>(b) | std::bit_cast<Bits>(c);
  return (bits[0] | bits[1]) == 0;
}

inline float AppearanceStar::sum(const Four& four) {
  return (four[0] + four[1]) + (four[2] + four[3]);
}

inline void AppearanceStar::add(const StarTriangle& t, const Values& values) {
  if (is_empty_) {
    base_ = values.end;
    base_numbers_ = numbers(base_);
    is_empty_ = false;
  }
  if (!(t.squared_size > 0 && std::isfinite(t.squared_size))) return;
  const double area = 0.5 * std::sqrt(t.squared_size);
  const Four end = numbers(values.end);
  const Four rise_p = seen(numbers(values.p) - end);
  const Four rise_q = seen(numbers(values.q) - end);
  const Four from_base = seen(end - base_numbers_);
  if (is_zero(rise_p, rise_q, from_base)) {
    area_ += area;
    return;
  }
  // The gradient of the linear function: normal x (to_p rise_q - to_q rise_p) / |normal|^2.
  const Vec3 to_p = t.p - t.end;
  const Vec3 to_q = t.q - t.end;
  const Vec3 n = t.normal * (1 / t.squared_size);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const Four rx = rise_q * narrow(to_p.x) - rise_p * narrow(to_q.x);
  const Four ry = rise_q * narrow(to_p.y) - rise_p * narrow(to_q.y);
  const Four rz = rise_q * narrow(to_p.z) - rise_p * narrow(to_q.z);
  Four gx = rz * narrow(n.y) - ry * narrow(n.z);
  Four gy = rx * narrow(n.z) - rz * narrow(n.x);
  Four gz = ry * narrow(n.x) - rx * narrow(n.y);
  const float steepness = sum(gx * gx + gy * gy + gz * gz);
  if (!std::isfinite(steepness)) return;  // a needle
  if (steepness > steepest_ * steepest_) {
    const float scale = steepest_ / std::sqrt(steepness);
    gx *= scale;
    gy *= scale;
    gz *= scale;
  }
  const Four height =
      from_base - (gx * narrow(t.end.x) + gy * narrow(t.end.y) + gz * narrow(t.end.z));
  is_even_ = false;
  area_ += area;
  const float weight = narrow(area);
  const Four wx = gx * weight;
  const Four wy = gy * weight;
  const Four wz = gz * weight;
  const Four wh = height * weight;
  gx_ += wx;
  gy_ += wy;
  gz_ += wz;
  height_ += wh;
  xx_ += wx * gx;
  xy_ += wx * gy;
  xz_ += wx * gz;
  yy_ += wy * gy;
  yz_ += wy * gz;
  zz_ += wz * gz;
  hx_ += wh * gx;
  hy_ += wh * gy;
  hz_ += wh * gz;
  hh_ += wh * height;
}

}  // namespace meshfarm
