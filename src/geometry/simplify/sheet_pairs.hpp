// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/point_index.hpp>

namespace meshfarm {

/// Pairs of sheets of a wall that have the same triangles, mirrored, as a surface and its offset
/// have. One sheet can stand for both while it is simplified, so that they do not cross, however
/// near they are.
class SheetPairs {
 public:
  struct Wall {
    std::uint32_t locked = 0;  // of the mesh: the first vertices
    PositionType positions = PositionType::float64;
    double reach = 0;                // no vertex is farther from its twin
    std::uint64_t most_held_up = 0;  // maximum number of vertices held where sheets end
  };

  /// Nothing unless more than half of the triangles have a twin. `flags` are those of the vertices
  /// (VertexFlag): only vertices flagged as k_thin have twins. The mesh must have no appearances
  /// and no columns.
  static std::optional<SheetPairs> find(const Mesh& mesh, std::span<const std::uint8_t> flags,
                                        const Wall& wall);

  /// One sheet of each pair and all other triangles; may be taken once. The first locked() vertices
  /// must stay: the locked ones of the mesh, then those where a sheet ends. If not all triangles
  /// have a twin, labels tell which do.
  Mesh take_single() { return std::move(single_); }
  std::uint32_t locked() const { return static_cast<std::uint32_t>(twins_.size()); }

  /// What the single mesh has become, with the twins added. Unused vertices are dropped, except the
  /// locked ones of the mesh, which come first.
  Mesh both(const Mesh& single) const;
  /// How many triangles both(single) has.
  std::uint64_t triangles_of(const Mesh& single) const;

 private:
  explicit SheetPairs(const Wall& wall) : wall_(wall) {}
  bool has_twin(const Mesh& single, std::size_t triangle) const {
    return single.columns.labels.empty() || single.columns.labels[triangle] == k_paired;
  }
  static constexpr Label k_paired = 1;
  friend class SheetPairing;

  Wall wall_;
  Mesh single_;
  std::vector<std::uint32_t> twins_;  // of the vertices that stay: in the single mesh, or none
  std::optional<PointIndex> places_;  // of the vertices with twins at the start
  std::vector<Vec3> ways_;            // offsets from these to their twins
};

}  // namespace meshfarm
