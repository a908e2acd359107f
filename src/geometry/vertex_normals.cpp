// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/vertex_normals.hpp>

namespace meshfarm {
namespace {

/// The arc cosine, identical on all machines, which std::acos is not (Abramowitz & Stegun 1964,
/// 4.4.45).
double angle_of(double cosine) {
  const double x = std::min(1.0, std::abs(cosine));
  const double angle =
      std::sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 + x * -0.0187293)));
  return cosine < 0 ? 3.14159265358979 - angle : angle;
}

Vec3 unit_or_zero(Vec3 v) {
  const double size = length(v);
  return size > 0 && std::isfinite(size) ? v * (1 / size) : Vec3{};
}

}  // namespace

std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]];
    const Vec3 b = mesh.positions[t[1]];
    const Vec3 c = mesh.positions[t[2]];
    const Vec3 normal = unit_or_zero(cross(b - a, c - a));
    const Vec3 ab = unit_or_zero(b - a);
    const Vec3 bc = unit_or_zero(c - b);
    const Vec3 ca = unit_or_zero(a - c);
    normals[t[0]] = normals[t[0]] + normal * angle_of(-dot(ca, ab));
    normals[t[1]] = normals[t[1]] + normal * angle_of(-dot(ab, bc));
    normals[t[2]] = normals[t[2]] + normal * angle_of(-dot(bc, ca));
  }
  for (Vec3& normal : normals) normal = unit_or_zero(normal);
  return normals;
}

}  // namespace meshfarm
