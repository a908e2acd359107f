// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// What the triangles of a surface tell by themselves, in the mesh's unit and in degrees.
struct ShapeMeasures {
  double area = 0;
  /// Signed: above 0 if the triangles face outwards. Means something only if the surface is closed
  /// (Topology::unmatched_edges is 0).
  double volume = 0;
  /// Of the triangles' smallest angles one in a hundred is not greater than this; to a thousandth
  /// of a degree. Triangles with corners at one place are left out, others without area have 0.
  double smallest_angle_p1 = 0;
  double share_below_5 = 0;  // of the triangles: with an angle below 5 degrees
};

/// Measures a surface that comes piece by piece. The figures depend on the pieces by rounding only,
/// and on no threads (0: one a core).
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
  std::vector<std::uint64_t> angles_;  // how many smallest angles are so many thousandths
};

/// Edges of more degrees than this between the normals of their triangles are features.
inline constexpr double k_feature_degrees = 40;

struct EdgeLengths {
  double border = 0;   // of one triangle
  double feature = 0;  // of two, with a feature between them
};

/// Vertices are welded as in a run, triangles of two corners left out. Depends on no threads (0:
/// one a core). Memory: about 45 bytes a triangle.
EdgeLengths measure_edge_lengths(const Mesh& mesh, unsigned threads);

}  // namespace meshfarm
