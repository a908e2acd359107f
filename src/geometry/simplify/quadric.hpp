// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// A symmetric 3x3 matrix A. With x measured from a point that lies in all the planes added,
/// x'Ax is the weighted sum of x's squared distances to them (Garland & Heckbert 1997).
/// A memoryless quadric needs no more: all planes of a vertex's star pass through the vertex,
/// so nothing is lost to a far origin.
struct Quadric {
  double xx = 0;
  double xy = 0;
  double xz = 0;
  double yy = 0;
  double yz = 0;
  double zz = 0;

  /// Adds weight * n n'.
  void add(Vec3 n, double weight) {
    const Vec3 w = n * weight;
    xx += w.x * n.x;
    xy += w.x * n.y;
    xz += w.x * n.z;
    yy += w.y * n.y;
    yz += w.y * n.z;
    zz += w.z * n.z;
  }
  double trace() const { return xx + yy + zz; }

  friend Quadric operator+(const Quadric& a, const Quadric& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
  }
  friend Quadric operator-(const Quadric& a, const Quadric& b) {
    return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
  }
  friend Quadric operator*(const Quadric& a, double s) {
    return {a.xx * s, a.xy * s, a.xz * s, a.yy * s, a.yz * s, a.zz * s};
  }
  friend Vec3 operator*(const Quadric& a, Vec3 x) {
    return {a.xx * x.x + a.xy * x.y + a.xz * x.z, a.xy * x.x + a.yy * x.y + a.yz * x.z,
            a.xz * x.x + a.yz * x.y + a.zz * x.z};
  }
};

/// The x with (A + ridge I) x = b, by Cramer's rule; zero if there is none.
inline Vec3 solve(const Quadric& a, double ridge, Vec3 b) {
  const double xx = a.xx + ridge;
  const double yy = a.yy + ridge;
  const double zz = a.zz + ridge;
  const Vec3 c0{yy * zz - a.yz * a.yz, a.xz * a.yz - a.xy * zz, a.xy * a.yz - a.xz * yy};
  const double determinant = xx * c0.x + a.xy * c0.y + a.xz * c0.z;
  if (!(determinant > 0)) return {};
  const double c11 = xx * zz - a.xz * a.xz;
  const double c12 = a.xy * a.xz - xx * a.yz;
  const double c22 = xx * yy - a.xy * a.xy;
  const Vec3 x{c0.x * b.x + c0.y * b.y + c0.z * b.z, c0.y * b.x + c11 * b.y + c12 * b.z,
               c0.z * b.x + c12 * b.y + c22 * b.z};
  return x * (1.0 / determinant);
}

/// Weight of a border relative to a crease. Where a border moves within its surface, only a narrow
/// strip is gained or lost: with the weight of creases, borders get triangles that the surface
/// lacks.
constexpr double k_border_weight = 0.1;

/// k_border_weight, or 1 at a corner: where two edges of a border leave a vertex at less than 120
/// degrees. With the lower weight, sheets lose their corners.
inline double border_weight_between(Vec3 edge, Vec3 other) {
  constexpr double k_cos_of_corner = -0.5;
  const double lengths = std::sqrt(squared_length(edge) * squared_length(other));
  return dot(edge, other) > k_cos_of_corner * lengths ? 1 : k_border_weight;
}

/// Adds the plane through an edge of a border or crease, perpendicular to a triangle there, which
/// keeps the line in place. It has the weight of three squares on the edge, times `weight`. Adds
/// nothing for a triangle of no area.
inline void add_line_plane(Quadric& quadric, Vec3 triangle_normal, Vec3 edge, double weight = 1) {
  constexpr double k_weight = 3;
  const Vec3 n = cross(triangle_normal, edge);
  const double scale = squared_length(n);
  if (scale > 0 && std::isfinite(scale))
    quadric.add(n, weight * k_weight * squared_length(edge) / scale);
}

/// Weight of a side of a ribbon relative to other borders: proportionally less where the triangle's
/// height is below a twentieth of the edge. There is little surface behind such a side, and it
/// would outweigh the ribbon's ends.
inline double weight_of_side(Vec3 triangle_normal, Vec3 edge) {
  constexpr double k_low = 0.05;
  return std::min(1.0, length(triangle_normal) / (k_low * squared_length(edge)));
}

/// The planes that the stars of some vertices had, or the positions of some ends, about the
/// position of the vertex that they have become: x costs x'Ax - 2 b'x + c (Garland & Heckbert
/// 1997).
struct PastPlanes {
  Quadric a;
  Vec3 b;
  double c = 0;

  /// The squared distance from here, times a weight.
  static PastPlanes here(double weight) { return {{weight, 0, 0, weight, 0, weight}, {}, 0}; }
  bool empty() const { return !(a.trace() > 0); }
  double cost(Vec3 x) const { return dot(a * x - b * 2.0, x) + c; }
  /// About the point x.
  PastPlanes about(Vec3 x) const { return {a, b - a * x, cost(x)}; }
  friend PastPlanes operator+(const PastPlanes& p, const PastPlanes& q) {
    return {p.a + q.a, p.b + q.b, p.c + q.c};
  }
};

/// The planes round an edge, about its middle: x costs x'Ax - 2 b'x + c.
struct EdgeQuadric {
  Quadric a;
  Vec3 b;
  double c = 0;
  double squared_length = 0;
  double squared_rounding = 0;  // of the spacing of coordinates here
  // Sums over all triangles: the normals, twice the area long, and their dot products with a point
  // of each triangle. Where dot(normals, x) == height, the volume is kept.
  Vec3 normals;
  double height = 0;
  double twice_area = 0;

  /// Adds planes that all pass through `point`.
  void add(const Quadric& planes, Vec3 point) {
    const Vec3 moved = planes * point;
    a = a + planes;
    b = b + moved;
    c += dot(moved, point);
  }
  void add(const PastPlanes& past) {
    a = a + past.a;
    b = b + past.b;
    c += past.c;
  }

  /// Where the cost is least. In directions that the planes leave open, it stays at the middle. A
  /// ridge of 1e-3 cost 6 % of the error at 10 % of the triangles; 1e-6 or 1e-8 gained nothing.
  Vec3 cheapest() const { return solve(a, ridge(), b); }

  /// Three tenths of the way from cheapest() to where the volume is kept (Lindstrom & Turk 1998):
  /// with planes alone, round shapes swell. This saves a third of the error on thin pins, 2 to 11 %
  /// on CT and indoor scans, and costs up to 2 % on a dragon. Half of the way saves 1 to 4 % more
  /// on the former and costs as much again on the dragon.
  Vec3 best() const {
    constexpr double k_least_normal =
        0.1;  // of the area: what faces all ways has no volume to keep
    constexpr double k_way = 0.3;
    const Vec3 start = cheapest();
    const double least = k_least_normal * twice_area;
    if (!(meshfarm::squared_length(normals) > least * least)) return start;
    return moved(start, normals, height, k_way);
  }

  /// Goes from `start` a share of the way to where dot(normal, x) == level, along the cheapest way.
  Vec3 moved(Vec3 start, Vec3 normal, double level, double share) const {
    const Vec3 way = solve(a, ridge(), normal);
    const double rise = dot(normal, way);
    if (!(rise > 0)) return start;
    return start + way * (share * (level - dot(normal, start)) / rise);
  }

  /// Nearly parallel planes meet far away: a point farther from the middle than the edge's length
  /// would make spikes of thin walls.
  bool is_near(Vec3 x) const { return meshfarm::squared_length(x) <= squared_length; }

  /// The sum of weight x squared distance; rounding noise counts as zero.
  double cost(Vec3 x) const { return unless_noise(dot(a * x - b * 2.0, x) + c); }
  /// The value, or zero if it is no more than rounding noise.
  double unless_noise(double value) const {
    return value > 1e-14 * a.trace() * squared_length ? value : 0.0;
  }

  /// Planes are infinite and do not see a thin spike or tube draw back: only its tiny tip moves
  /// away from its planes. The lost area measures that. Nor do planes see the rim of a wall without
  /// thickness slide outwards in its plane; the gained area measures that. It lies no farther out
  /// than its width along the edge: if it counted as far out as the edge is long, hair and tubes
  /// would have 1.5 to 1.7 times the error. With weights of 0.1, the error of CT scans is 20 %
  /// higher and the greatest distance of a dragon seven times as far; from 1 on, flat surfaces lose
  /// 5 %. Weights by the longest edge helped less. Rounding is not charged: the area that a
  /// straight fold loses to it grows with the offset of its vertices, its cost by planes only with
  /// the square, so small parts beside long folds would go first.
  double cost_of_lost_area(double area) const {
    if (area * area <= squared_rounding * squared_length) return 0;
    constexpr double k_of_lost = 0.8;
    constexpr double k_of_gained = 0.2;
    constexpr double k_squared_widths = 25;
    if (area > 0) return unless_noise(k_of_lost * area * squared_length);
    const double squared_width = area * area / squared_length;
    return unless_noise(-k_of_gained * area *
                        std::min(squared_length, k_squared_widths * squared_width));
  }
  /// How much of that cost is not charged where planes cost `planes`: a surface that bends evenly
  /// loses area wherever it is simplified, and its planes already charge for that. Charged in full,
  /// CAD and bodies have 4 % more error. Sparing twice as much costs thin bridges 2 %.
  static double area_cost_of_bends(double planes) {
    constexpr double k_of_planes = 2.4;
    return k_of_planes * planes;
  }

 private:
  double ridge() const { return 1e-5 * a.trace(); }
};

}  // namespace meshfarm
