// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// What a texture shows outside its bounds.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// The property of a material that a picture gives.
enum class MapUse : std::uint8_t { colour, normal, metal_and_roughness, occlusion, emission };

/// A picture of a material, by its index among the mesh's pictures.
struct MaterialMap {
  MapUse use = MapUse::colour;
  std::uint32_t picture = 0;

  bool operator==(const MaterialMap&) const = default;
};

/// A material, reduced to what every format has a place for.
struct Material {
  std::string name;
  std::array<float, 4> colour{1, 1, 1, 1};  // linear red, green, blue, and alpha, 0 to 1
  std::vector<MaterialMap> maps = {};       // placed by the triangles' texture coordinates
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;

  bool operator==(const Material&) const = default;
};

/// The meaning of the labels of a mesh's triangles.
struct LabelMeaning {
  std::string name;                 // "material", "group", or the name of the file's property
  std::vector<Material> materials;  // of the labels 0, 1, ...; empty if labels are only numbers

  bool operator==(const LabelMeaning&) const = default;
};

/// A triangle of a whole mesh: 64-bit vertex indices.
using WideTriangle = std::array<std::uint64_t, 3>;

/// Triangles of a whole mesh, and their columns.
struct TriangleView {
  TriangleView() = default;
  TriangleView(std::span<const WideTriangle> of_corners, const TriangleColumnsView& of_columns = {})
      : corners(of_corners), columns(of_columns) {}
  TriangleView(const std::vector<WideTriangle>& of_corners) : corners(of_corners) {}

  std::size_t size() const { return corners.size(); }
  TriangleView part(std::size_t first, std::size_t count = std::dynamic_extent) const {
    return {corners.subspan(first, count), columns.part(first, count)};
  }
  operator std::span<const WideTriangle>() const { return corners; }

  std::span<const WideTriangle> corners;
  TriangleColumnsView columns;
};

/// The pictures of materials, as whole files.
struct PictureFiles {
  std::vector<std::string> names;  // of files, with an extension that fits the content
  /// The bytes of one. Throws IoError, or DataError, if it can no longer be read.
  std::function<std::string(std::size_t picture)> load;
};

}  // namespace meshfarm
