// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// How columns of values are compared.
enum class ValueKind : std::uint8_t {
  numbers,    // by their differences
  direction,  // three columns, by the angle between two vectors, in degrees
};

/// Columns that are compared as one, such as the three of a colour.
struct ValueGroup {
  ValueKind kind = ValueKind::numbers;
  std::size_t columns = 1;
};

/// Computes the values at the place of a triangle where its corners have these shares. Called by
/// several threads at once.
using ValuesAt = std::function<void(std::uint32_t triangle, const std::array<double, 3>& shares,
                                    std::span<double> values)>;

/// A mesh and the values of its vertices: the columns of all groups of each vertex, one after the
/// other.
struct ValuedMesh {
  const Mesh& mesh;
  std::span<const float> values;
  ValuesAt values_at = {};             // if not empty, replaces the vertices' values
  std::span<const Label> labels = {};  // of the triangles; the same numbers in both meshes
};

/// Differences between the values of two surfaces, over sampled points and the group's columns.
struct ValueError {
  double rms = 0;
  double mean = 0;
  double max = 0;
  /// The number of points where both surfaces have values: finite numbers, non-zero vectors.
  std::uint64_t samples = 0;
};

/// Distances exceeded by 5 % and 1 % of the sampled points. Exact for these points.
struct DistanceQuantiles {
  double p95 = 0;
  double p99 = 0;
};

DistanceQuantiles quantiles_of(std::span<double> distances);

/// How the triangles of sampled points are turned relative to those at the nearest points of the
/// other surface: the angles between their normals, in degrees. Where several triangles are
/// nearest, as at an edge, the one that is turned least counts.
struct NormalDeviation {
  double rms = 0;
  double p95 = 0;      // 5 % of the area is turned by more
  double over_90 = 0;  // the share of the area that faces the other way
};

struct SurfaceError {
  Distance distance;
  DistanceQuantiles quantiles;
  std::optional<NormalDeviation> normals;  // if they were measured
  std::vector<ValueError> values;          // by group
  /// The share of the points whose label differs there; 0 unless both surfaces have labels.
  double other_labels = 0;
};

/// Measures the same distances as measure_distance, bit for bit, except the greatest: that is
/// searched for at all triangle corners, and in the triangles that are farthest. At the same points
/// it measures by how much values and labels differ between the point and the nearest point of
/// `to`; values are interpolated linearly over the triangle, or given by ValuesAt. Memory and
/// errors are those of measure_distance, plus 12 bytes per sample. `with_index` may make further
/// measurements with the index of the mesh of `to`.
SurfaceError measure_error(const ValuedMesh& from, const ValuedMesh& to,
                           std::span<const ValueGroup> groups, const DistanceOptions& options,
                           const std::function<void(const TriangleIndex&)>& with_index = {});

}  // namespace meshfarm
