// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {

/// A vertex on a line (a border or a crease) merges with others along that line only; vertices that
/// merge into it from the side take its position. At a corner lines meet or end: it stays where it
/// is.
constexpr std::uint8_t k_line = k_border | k_crease;

/// Of two vertices that merge, the one of the higher rank keeps its position.
inline int line_rank(std::uint8_t flags) {
  if ((flags & k_corner) != 0) return 2;
  return (flags & k_line) != 0 ? 1 : 0;
}

/// Neighbours with these flags are not partners across a triangle: lines would be pinched.
inline std::uint8_t barred_beside(std::uint8_t flags) {
  return (flags & k_line) != 0 ? k_line : 0;
}
/// Neighbours with these flags are not partners along a line.
inline std::uint8_t barred_along(std::uint8_t flags) {
  return (flags & k_corner) != 0 ? k_corner : 0;
}

/// Weight of the planes along a line between labels. These lines are all that is seen of labels,
/// and should be as exact as the surface. At 2 % of the triangles, a weight of 5 leaves them less
/// exact than the surface of a scan in 60 cells whose jags hold half of the vertices; from 4 to 7
/// costs the surface 10 to 13 % there. If seams of texture coordinates had the same weight, models
/// with many charts would have 1.1 to 1.5 times the error.
///
/// Where more than half of the vertices are on such lines, as where labels are as fine as what is
/// left of the mesh, the weight is halved for each two per cent more. Otherwise the lines would
/// hold nearly all vertices, leaving few for the surface.
double label_line_weight(std::uint64_t on_lines, std::uint64_t vertices);

/// Recognises creases by the angle: inner edges whose two triangles' normals differ by more.
class CreaseTest {
 public:
  /// `degrees` in (0, 180), or 0: no edge is one.
  explicit CreaseTest(double degrees);

  /// Weight of the planes along a crease.
  double weight(bool is_between_labels) const { return is_between_labels ? of_labels_ : 1; }
  void weigh_labels(double weight) { of_labels_ = weight; }

  /// Whether the edge from `at` to `end`, between the triangles (at, right, end) and (at, end,
  /// left), is a crease.
  bool is_crease(Vec3 at, Vec3 right, Vec3 end, Vec3 left) const {
    const Vec3 n0 = cross(right - at, end - at);
    const Vec3 n1 = cross(end - at, left - at);
    const double turn = dot(n0, n1);
    const double lengths = squared_length(n0) * squared_length(n1);
    if (!(lengths > 0)) return false;
    return turn * std::abs(turn) < cosine_squared_ * lengths;
  }

 private:
  double cosine_squared_;  // with the cosine's sign
  double of_labels_ = 1;
};

/// Calls take(one, other, is_between_labels) for the edges of a fan at the vertex at `at` that are
/// creases, seams, or lie between two labels: the triangle that ends at the edge and the one that
/// begins there, so that the edge's other end is one.prev == other.next. `is_candidate` says which
/// ends to look at.
template <typename Candidate, typename Take>
void for_crease_edges(const CornerFan& fan, Vec3 at, std::span<const Vec3> positions,
                      const CreaseTest& test, const Candidate& is_candidate, const Take& take) {
  for (std::size_t i = 0; i < fan.corners.size(); ++i) {
    const Corner& one = fan.corners[i];
    if (!is_candidate(one.prev)) continue;
    for (std::size_t k = 0; k < fan.corners.size(); ++k) {
      const Corner& other = fan.corners[k];
      if (other.next != one.prev) continue;
      if (fan.differ(i, k) ||
          test.is_crease(at, positions[one.next], positions[one.prev], positions[other.prev])) {
        take(one, other, fan.labels_differ(i, k));
      }
    }
  }
}

/// Keeps the flags of creases up to date while the mesh is simplified. An edge where labels meet is
/// a crease, whatever the angle.
class CreaseLines {
 public:
  /// An angle of 0 means no creases except these.
  CreaseLines(double degrees, bool labels)
      : exists_(degrees > 0 || labels), sharp_(degrees), still_sharp_(degrees / 2) {}

  bool exist() const { return exists_; }
  /// The test by which lines are followed once they are found: sooner or later some edge of a line
  /// is less sharp than its neighbours, and the line must not break there.
  const CreaseTest& test() const { return still_sharp_; }

  /// Flags the creases of the input and their corners.
  void find(const Mesh& mesh, const Adjacency& adjacency, std::vector<std::uint8_t>& flags);
  /// Unflags vertices that are no longer on a crease, finds the corners again, and weighs lines
  /// between labels.
  void update(const Mesh& mesh, const Adjacency& adjacency, std::vector<std::uint8_t>& flags);
  /// The flags of one vertex as they should be.
  std::uint8_t updated(std::uint32_t vertex, std::span<const Vec3> positions,
                       const Adjacency& adjacency, std::span<const std::uint8_t> flags) const;

 private:
  struct Updated {
    std::uint8_t flags = 0;
    bool is_between_labels = false;
  };
  Updated look_at(std::uint32_t vertex, std::span<const Vec3> positions, const Adjacency& adjacency,
                  std::span<const std::uint8_t> flags) const;

  bool exists_;
  CreaseTest sharp_;
  CreaseTest still_sharp_;
};

}  // namespace meshfarm
