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
  unsigned threads = 1;  // 0: one a core. Nothing depends on it.
  /// What is simplified may be nearly so far already, and not the surface itself.
  bool is_used_up = false;
};

struct SurfacePoint {
  Vec3 at;
  std::uint32_t triangle = 0;  // that it lies on
  /// It stands for a triangle round it, as large as this share of its own; below 0: of one that is
  /// turned round.
  float share = 0;
  /// A vertex of small triangles only: the surface has others near it.
  bool is_dense = false;
};

/// A surface, and how far one that is made of it may be from it and it from that. Needs about 110
/// bytes a triangle, 40 for each point, and 8 for each long side.
class SurfaceBound {
 public:
  /// The mesh must have a triangle and finite coordinates.
  SurfaceBound(Mesh surface, const SurfaceBoundOptions& options);
  ~SurfaceBound();
  SurfaceBound(SurfaceBound&&) noexcept;

  const SurfaceBoundOptions& options() const;
  double distance() const { return options().distance; }
  /// What stands for the surface: its vertices first, and points inside of large triangles.
  std::span<const SurfacePoint> points() const;
  /// Of a vertex's point: those at the other ends of its sides, if they are so long that the points
  /// alone do not tell how far they are from another surface.
  std::span<const std::uint32_t> across_sides(std::uint32_t point) const;
  const Mesh& surface() const;
  /// Of the surface, for other measures.
  const TriangleIndex& index() const;
  /// The squared distance to a triangle of the surface near the point, one that is within the bound
  /// if any is; infinite if none is. Stops to look at `enough`. `guess` is a triangle, becomes the
  /// one that was found, and saves time if it is near the point.
  double squared_distance_near(Vec3 point, double enough, std::uint32_t& guess) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
