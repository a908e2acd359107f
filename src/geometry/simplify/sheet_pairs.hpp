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

/// Two sheets of a wall that have the same triangles, the one as seen in a mirror: what a surface
/// and its offset have. One of them can stand for both while it is simplified, so that they do not
/// cross, however near they are.
class SheetPairs {
 public:
  struct Wall {
    std::uint32_t locked = 0;  // of the mesh: the first vertices
    PositionType positions = PositionType::float64;
    double reach = 0;                // no vertex is farther from its twin
    std::uint64_t most_held_up = 0;  // no more vertices are held where sheets end than so many
  };

  /// None where no more than half of the triangles have a twin. `flags` are the vertices'
  /// (VertexFlag): twins are those of vertices flagged as k_thin. The mesh must have no appearances
  /// and no columns.
  static std::optional<SheetPairs> find(const Mesh& mesh, std::span<const std::uint8_t> flags,
                                        const Wall& wall);

  /// One sheet of each pair and all else, to be taken once. The first locked() vertices must stay:
  /// those of the mesh that are locked, and then those where a sheet ends. If not all triangles
  /// have a twin, labels tell which have.
  Mesh take_single() { return std::move(single_); }
  std::uint32_t locked() const { return static_cast<std::uint32_t>(twins_.size()); }

  /// What has become of the single mesh, with the twins; without unused vertices but the locked
  /// ones of the mesh, which come first.
  Mesh both(const Mesh& single) const;
  /// How many triangles that has.
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
  std::vector<Vec3> ways_;            // from these to their twins
};

}  // namespace meshfarm
