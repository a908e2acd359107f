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

/// Renumbers the vertices: those that are flagged come last, the order kept otherwise. Returns how
/// many are not.
std::uint32_t put_last(Mesh& mesh, const std::vector<std::uint8_t>& flags);

/// What is simplified to a bound that is to be proven tries these shares of it, until the proof
/// holds.
inline constexpr std::array<double, 4> k_certified_shares = {1, 0.85, 0.6, 0.3};

/// Proves that no point of a surface is farther than a distance from a result, and none of the
/// result farther from the surface.
class BoundProof {
 public:
  /// Of the surface, triangles with two corners at one place do not count.
  BoundProof(Mesh surface, double distance, unsigned threads);
  BoundProof(const BoundProof&) = delete;  // the index knows where the surface is
  BoundProof& operator=(const BoundProof&) = delete;

  /// False where it may not be so.
  bool holds_for(const Mesh& result) const;
  /// Whether the result is near the surface: that direction alone.
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
