// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A material as far as every format has a place for it.
struct Material {
  std::string name;
  std::array<float, 4> colour{1, 1, 1, 1};  // linear red, green, blue, and alpha, 0 to 1

  bool operator==(const Material&) const = default;
};

/// What the labels of a mesh's triangles say.
struct LabelMeaning {
  std::string name;                 // "material", "group", or as the file's property has it
  std::vector<Material> materials;  // of the labels 0, 1, ...; none where labels are only numbers

  bool operator==(const LabelMeaning&) const = default;
};

/// A triangle of a whole mesh: 64-bit vertex indices.
using WideTriangle = std::array<std::uint64_t, 3>;

/// Triangles of a whole mesh, and their labels if it has any.
struct TriangleView {
  TriangleView() = default;
  TriangleView(std::span<const WideTriangle> of_corners, std::span<const Label> of_labels = {})
      : corners(of_corners), labels(of_labels) {}
  TriangleView(const std::vector<WideTriangle>& of_corners) : corners(of_corners) {}

  std::size_t size() const { return corners.size(); }
  TriangleView part(std::size_t first, std::size_t count = std::dynamic_extent) const {
    return {corners.subspan(first, count), labels.empty() ? labels : labels.subspan(first, count)};
  }
  operator std::span<const WideTriangle>() const { return corners; }

  std::span<const WideTriangle> corners;
  std::span<const Label> labels;
};

}  // namespace meshfarm
