// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

#include "gltf_json.hpp"

namespace meshfarm {

/// An affine map: x a.x + y a.y + z a.z + origin.
struct GltfTransform {
  Vec3 x{1, 0, 0};
  Vec3 y{0, 1, 0};
  Vec3 z{0, 0, 1};
  Vec3 origin{};

  bool operator==(const GltfTransform&) const = default;
  bool is_identity() const { return *this == GltfTransform{}; }
  Vec3 turned(Vec3 a) const { return x * a.x + y * a.y + z * a.z; }
  Vec3 of(Vec3 a) const { return turned(a) + origin; }
  /// Whether it turns triangles over.
  bool is_mirror() const { return dot(cross(x, y), z) < 0; }
  /// The direction of a normal, of any length.
  Vec3 of_normal(Vec3 a) const;
};

/// Applies `inner` first, then `outer`.
GltfTransform combined(const GltfTransform& outer, const GltfTransform& inner);

/// A mesh as placed by a node of the scene.
struct GltfInstance {
  std::uint64_t mesh = 0;
  GltfTransform transform;
};

struct GltfScene {
  std::vector<GltfInstance> instances;
  /// How many of these EXT_mesh_gpu_instancing would show in many places; they come once.
  std::uint64_t repeated = 0;
};

/// The meshes of the default scene, in the order of its nodes, children after their parents. A
/// document without scenes shows all nodes, one without nodes all meshes. A mesh with a skin is not
/// moved by its node, only by its bones, which are not read. Throws DataError where the nodes do
/// not form trees.
GltfScene read_gltf_scene(const GltfValue& document);

}  // namespace meshfarm
