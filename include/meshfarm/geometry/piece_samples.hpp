// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/geometry/value_error.hpp>

namespace meshfarm {

/// A point of a surface, and the normal of its triangle, of any length.
struct FacingPoint {
  Vec3 at;
  Vec3 normal;
};

/// What a piece of a surface contributes to the whole.
struct PieceSamples {
  double area = 0;    // each point stands for an equal share of it
  double volume = 0;  // between it and the origin, signed
  std::vector<FacingPoint> points;
};

/// Takes `count` points, stratified by area; none if the piece has no area.
PieceSamples sample_piece(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          std::uint64_t count, Vec3 origin);
/// Takes `count(area)` points of a piece that has an area.
PieceSamples sample_piece(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const std::function<std::uint64_t(double area)>& count, Vec3 origin);

/// Where a mesh is nearest to a point.
struct NearPlace {
  double distance = 0;
  std::uint32_t triangle = 0;
  float degrees = -1;  // angle of its normal to the point's normal; -1 without normals
};

/// The result does not depend on the threads (0: one per core).
std::vector<NearPlace> find_near_places(const TriangleIndex& index,
                                        std::span<const FacingPoint> points, unsigned threads);

/// The deviation over places, each weighted by its area. Places without normals do not count.
NormalDeviation normals_of(std::span<const NearPlace> places, std::span<const double> areas);

}  // namespace meshfarm
