// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A point of a mesh's surface.
struct SurfacePlace {
  std::uint32_t triangle = 0;
  std::array<double, 3> shares{};  // of its corners: not negative, sum 1
  double squared = 0;              // the squared distance from the query point
};

/// Interpolates the corners' values by their shares at a place.
template <std::size_t N>
std::array<float, N> blended(const SurfacePlace& place, const std::array<float, N>& a,
                             const std::array<float, N>& b, const std::array<float, N>& c) {
  std::array<float, N> made{};
  for (std::size_t i = 0; i < N; ++i) {
    made[i] = static_cast<float>(place.shares[0] * static_cast<double>(a[i]) +
                                 place.shares[1] * static_cast<double>(b[i]) +
                                 place.shares[2] * static_cast<double>(c[i]));
  }
  return made;
}

struct SurfacePlacesOptions {
  /// A triangle that faces against a point's normal is passed over if one that faces the same way
  /// is within this distance of the point. If parts of the mesh may be turned inside out, this
  /// should be little more than the distance between the surfaces.
  double reach = std::numeric_limits<double>::infinity();
  unsigned threads = 0;  // for building; 0: one per core
};

/// Finds the places of a surface that are nearest to given points. May be used by several threads
/// at once. Memory: up to 20 bytes per triangle, 40 while it is built.
class SurfacePlaces {
 public:
  /// `mesh` must outlive it and have finite coordinates and at least one triangle.
  SurfacePlaces(const Mesh& mesh, const SurfacePlacesOptions& options);
  ~SurfacePlaces();
  SurfacePlaces(SurfacePlaces&&) noexcept;

  /// The nearest place whose normal is within 90 degrees of `normal`, if one is in reach;
  /// otherwise, and for a zero normal, the nearest of all. A good `guess` of the triangle saves
  /// time.
  SurfacePlace find(Vec3 point, Vec3 normal, std::uint32_t guess = 0) const;
  /// The same for many points, which should be near each other, such as those of one triangle or
  /// one corner of a picture.
  void find(std::span<const Vec3> points, std::span<const Vec3> normals,
            std::span<SurfacePlace> places) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
