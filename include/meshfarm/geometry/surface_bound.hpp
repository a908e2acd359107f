// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

struct SurfaceBoundOptions {
  double distance = 0;   // above 0
  unsigned threads = 1;  // 0: one per core. Nothing depends on it.
  /// The mesh to be simplified may already be nearly this far away, and not be the surface itself.
  bool is_used_up = false;
};

struct SurfacePoint {
  Vec3 at;
  std::uint32_t triangle = 0;  // that it lies on
  /// The point stands for a triangle round it. This is that triangle's size as a share of the
  /// triangle it lies on; negative if it is turned upside down.
  float share = 0;
  /// A vertex with small triangles only: the surface has other vertices near it.
  bool is_dense = false;
};

/// A surface, and how far a surface made from it may be from it, in both directions. Needs about
/// 110 bytes per triangle, 40 per point, and 8 per long side.
class SurfaceBound {
 public:
  /// The mesh must have a triangle and finite coordinates.
  SurfaceBound(Mesh surface, const SurfaceBoundOptions& options);
  ~SurfaceBound();
  SurfaceBound(SurfaceBound&&) noexcept;

  const SurfaceBoundOptions& options() const;
  double distance() const { return options().distance; }
  /// Points that represent the surface: its vertices first, then points inside large triangles.
  std::span<const SurfacePoint> points() const;
  /// For a vertex's point: the points at the other ends of its long sides. Sides are long if their
  /// end points alone do not tell how far the sides are from another surface.
  std::span<const std::uint32_t> across_sides(std::uint32_t point) const;
  const Mesh& surface() const;
  /// The index of the surface, for other measurements.
  const TriangleIndex& index() const;
  /// The squared distance to a triangle of the surface near the point, one within the bound if
  /// there is any; infinite if there is none. Stops searching at `enough`. `guess` is a triangle;
  /// it saves time if it is near the point, and is set to the one found.
  double squared_distance_near(Vec3 point, double enough, std::uint32_t& guess) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
