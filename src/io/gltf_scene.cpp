// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace meshfarm {
namespace {

template <std::size_t N>
std::array<double, N> numbers(const GltfValue& list) {
  if (list.size() != N) list.fail("does not have " + std::to_string(N) + " numbers");
  std::array<double, N> made{};
  for (std::size_t i = 0; i < N; ++i) made[i] = list.item(i).real();
  return made;
}

GltfTransform of_matrix(const GltfValue& matrix) {
  const std::array<double, 16> m = numbers<16>(matrix);  // column by column
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
    matrix.fail("is not affine: its last row is not 0 0 0 1");
  }
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

/// The rotation of a quaternion, which is normalised first: one written with few digits has not
/// length 1.
GltfTransform of_rotation(const GltfValue& rotation) {
  std::array<double, 4> q = numbers<4>(rotation);
  double largest = 0;
  for (const double each : q) largest = std::max(largest, std::abs(each));
  if (largest == 0) rotation.fail("is a quaternion without a length");
  double squared = 0;
  for (double& each : q) {
    each /= largest;  // else the squares might not be finite
    squared += each * each;
  }
  for (double& each : q) each /= std::sqrt(squared);
  const auto [x, y, z, w] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
          {}};
}

GltfTransform transform_of(const GltfValue& node) {
  if (const std::optional<GltfValue> matrix = node.find("matrix")) return of_matrix(*matrix);
  GltfTransform made;
  if (const auto rotation = node.find("rotation")) made = of_rotation(*rotation);
  if (const auto scale = node.find("scale")) {
    const auto [x, y, z] = numbers<3>(*scale);
    made = {made.x * x, made.y * y, made.z * z, {}};
  }
  if (const auto translation = node.find("translation")) {
    const auto [x, y, z] = numbers<3>(*translation);
    made.origin = {x, y, z};
  }
  return made;
}

/// Visits the nodes without recursion: they may be nested as deep as there are nodes.
class SceneReader {
 public:
  explicit SceneReader(const GltfValue& document)
      : nodes_(document.find("nodes")), is_reached_(document.size_of("nodes")) {}

  /// The nodes without a parent.
  std::vector<std::uint64_t> roots() const {
    std::vector<bool> is_child(is_reached_.size());
    std::vector<std::uint64_t> made;
    for (std::uint64_t i = 0; i < is_child.size(); ++i) {
      const std::optional<GltfValue> children = nodes_->item(i).find("children");
      for (std::uint64_t c = 0; children && c < children->size(); ++c) {
        is_child[checked(children->item(c))] = true;
      }
    }
    for (std::uint64_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) made.push_back(i);
    }
    return made;
  }

  void visit(std::uint64_t root) {
    std::vector<Visit> open;
    enter(root, {}, open);
    while (!open.empty()) {
      const std::optional<GltfValue> children = nodes_->item(open.back().node).find("children");
      if (!children || open.back().next_child == children->size()) {
        open.pop_back();
        continue;
      }
      const std::uint64_t child = checked(children->item(open.back().next_child++));
      enter(child, GltfTransform(open.back().transform), open);
    }
  }

  std::uint64_t checked(const GltfValue& node) const {
    const std::uint64_t index = node.whole();
    if (index >= is_reached_.size()) {
      node.fail("is node " + std::to_string(index) + " of " + std::to_string(is_reached_.size()));
    }
    return index;
  }

  GltfScene take() { return std::move(scene_); }

 private:
  /// A node on the path from the root to the current one.
  struct Visit {
    std::uint64_t node = 0;
    std::uint64_t next_child = 0;
    GltfTransform transform;
  };

  void enter(std::uint64_t index, const GltfTransform& outer, std::vector<Visit>& open) {
    const GltfValue node = nodes_->item(index);
    if (is_reached_[index]) node.fail("is reached twice: the nodes are not a tree");
    is_reached_[index] = true;
    const GltfTransform transform = combined(outer, transform_of(node));
    if (const auto mesh = node.find("mesh")) {
      // A mesh with a skin is moved only by its bones.
      scene_.instances.push_back({mesh->whole(), node.find("skin") ? GltfTransform{} : transform});
      const auto extensions = node.find("extensions");
      if (extensions && extensions->find("EXT_mesh_gpu_instancing")) ++scene_.repeated;
    }
    open.push_back({index, 0, transform});
  }

  std::optional<GltfValue> nodes_;
  std::vector<bool> is_reached_;
  GltfScene scene_;
};

}  // namespace

Vec3 GltfTransform::of_normal(Vec3 a) const {
  // By the cofactors: they are the transposed inverse, except for the size of the determinant.
  const Vec3 turned = cross(y, z) * a.x + cross(z, x) * a.y + cross(x, y) * a.z;
  return is_mirror() ? turned * -1 : turned;
}

GltfTransform combined(const GltfTransform& outer, const GltfTransform& inner) {
  // Avoids needless rounding.
  if (outer.is_identity()) return inner;
  return {outer.turned(inner.x), outer.turned(inner.y), outer.turned(inner.z),
          outer.of(inner.origin)};
}

GltfScene read_gltf_scene(const GltfValue& document) {
  GltfScene made;
  if (document.size_of("nodes") == 0 && document.size_of("scenes") == 0) {
    for (std::uint64_t mesh = 0; mesh < document.size_of("meshes"); ++mesh) {
      made.instances.push_back({mesh, {}});
    }
    return made;
  }
  SceneReader reader(document);
  if (document.size_of("scenes") == 0) {
    for (const std::uint64_t root : reader.roots()) reader.visit(root);
    return reader.take();
  }
  const GltfValue scene = document.at("scenes").item(document.whole_or("scene", 0));
  const std::optional<GltfValue> roots = scene.find("nodes");
  for (std::uint64_t i = 0; roots && i < roots->size(); ++i) {
    reader.visit(reader.checked(roots->item(i)));
  }
  return reader.take();
}

}  // namespace meshfarm
