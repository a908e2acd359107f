// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/adjacency.hpp"
#include "geometry/vertex_flags.hpp"

namespace meshfarm {

/// A vertex on a line, a border or a crease, merges with others along that line only; what merges
/// into it from beside takes its position. At a corner lines meet or end: it stays where it is.
constexpr std::uint8_t k_line = k_border | k_crease;

/// Of two vertices that merge, the one of the higher rank keeps its position.
inline int line_rank(std::uint8_t flags) {
  if ((flags & k_corner) != 0) return 2;
  return (flags & k_line) != 0 ? 1 : 0;
}

/// Neighbours with these flags are no partners across a triangle: lines would be pinched.
inline std::uint8_t barred_beside(std::uint8_t flags) {
  return (flags & k_line) != 0 ? k_line : 0;
}
/// Nor are these along a line.
inline std::uint8_t barred_along(std::uint8_t flags) {
  return (flags & k_corner) != 0 ? k_corner : 0;
}

/// Tells creases: inner edges whose two triangles' normals differ by more than an angle.
class CreaseTest {
 public:
  /// `degrees` in (0, 180).
  explicit CreaseTest(double degrees);

  /// Of the edge from `at` to `end`, between the triangles (at, right, end) and (at, end, left).
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
};

/// Calls take(one, other) for the edges of a fan at the vertex at `at` that are creases: the
/// triangle that ends at the edge and the one that begins there, so that the edge's other end is
/// one.prev == other.next. `is_candidate` says which ends to look at.
template <typename Candidate, typename Take>
void for_crease_edges(std::span<const Corner> fan, Vec3 at, std::span<const Vec3> positions,
                      const CreaseTest& test, const Candidate& is_candidate, const Take& take) {
  for (const Corner& one : fan) {
    if (!is_candidate(one.prev)) continue;
    for (const Corner& other : fan) {
      if (other.next != one.prev) continue;
      if (test.is_crease(at, positions[one.next], positions[one.prev], positions[other.prev])) {
        take(one, other);
      }
    }
  }
}

/// Keeps the flags of creases true while the mesh is simplified.
class CreaseLines {
 public:
  /// An angle of 0 means no creases.
  explicit CreaseLines(double degrees)
      : exists_(degrees > 0), sharp_(exists_ ? degrees : 90), still_sharp_(sharp_angle(degrees)) {}

  bool exist() const { return exists_; }
  /// By which lines that are once found are followed: sooner or later some edge of a line is less
  /// sharp than its neighbours, and the line is not to break there.
  const CreaseTest& test() const { return still_sharp_; }

  /// Flags the creases of the input and their corners.
  void find(const Mesh& mesh, const Adjacency& adjacency, std::vector<std::uint8_t>& flags) const;
  /// Unflags what is on no crease any more, and tells corners anew.
  void update(const Mesh& mesh, const Adjacency& adjacency, std::vector<std::uint8_t>& flags) const;

 private:
  static double sharp_angle(double degrees) { return degrees > 0 ? degrees / 2 : 90; }

  bool exists_;
  CreaseTest sharp_;
  CreaseTest still_sharp_;
};

}  // namespace meshfarm
