// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Renumbers the vertices: flagged ones come last, the order is kept otherwise. Returns the number
/// of the others.
std::uint32_t put_last(Mesh& mesh, const std::vector<std::uint8_t>& flags);

/// Simplification to a bound that is to be proven tries these shares of it, until the proof holds.
inline constexpr std::array<double, 4> k_certified_shares = {1, 0.85, 0.6, 0.3};

/// Proves that no point of a surface is farther than a distance from a result, and no point of the
/// result farther from the surface.
class BoundProof {
 public:
  /// Triangles of the surface with two corners at one place do not count.
  BoundProof(Mesh surface, double distance, unsigned threads);
  BoundProof(const BoundProof&) = delete;  // the index refers to the surface
  BoundProof& operator=(const BoundProof&) = delete;

  /// False if this could not be proven.
  bool holds_for(const Mesh& result) const;
  /// Whether the result is near the surface: that direction only.
  bool is_near(const Mesh& result) const;
  /// The triangles of the surface that may be too far from the result.
  std::vector<Triangle> find_lost(const Mesh& result) const;

 private:
  Mesh surface_;
  std::optional<TriangleIndex> index_;
  double distance_;
  unsigned threads_;
};

}  // namespace meshfarm
