// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Measures of a surface's triangles, in the mesh's unit and in degrees.
struct ShapeMeasures {
  double area = 0;
  /// Signed: positive if the triangles face outwards. Meaningful only if the surface is closed
  /// (Topology::unmatched_edges is 0).
  double volume = 0;
  /// The first percentile of the triangles' smallest angles, to a thousandth of a degree. Triangles
  /// with coincident corners are left out; others without area have angle 0.
  double smallest_angle_p1 = 0;
  double share_below_5 = 0;  // of the triangles: those with an angle below 5 degrees
};

/// Measures a surface that is added piece by piece. The pieces affect the figures only by rounding,
/// and the threads (0: one per core) not at all.
class ShapeMeter {
 public:
  explicit ShapeMeter(unsigned threads);
  void add(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  ShapeMeasures measures() const;

 private:
  struct Sums {
    double area = 0;
    double volume = 0;
    std::uint64_t below_5 = 0;
  };
  Sums measure_block(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                     std::vector<std::uint32_t>& angles) const;

  unsigned threads_;
  std::optional<Vec3> origin_;  // volumes are those of tetrahedra with this point
  Sums sums_;
  std::uint64_t triangles_ = 0;        // that have angles
  std::vector<std::uint64_t> angles_;  // count of smallest angles per thousandth of a degree
};

/// Edges are features if the normals of their triangles differ by more degrees than this.
inline constexpr double k_feature_degrees = 40;

struct EdgeLengths {
  double border = 0;   // of edges with one triangle
  double feature = 0;  // of edges with two triangles, if they are features
};

/// Vertices are welded as in a run; triangles that then have only two corners are left out. The
/// result does not depend on the threads (0: one per core). Memory: about 45 bytes per triangle.
EdgeLengths measure_edge_lengths(const Mesh& mesh, unsigned threads);

}  // namespace meshfarm
