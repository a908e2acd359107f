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

/// What a texture shows beyond its sides.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// What a picture says of a material.
enum class MapUse : std::uint8_t { colour, normal, metal_and_roughness, occlusion, emission };

/// A picture that a material has, by its number among the mesh's.
struct MaterialMap {
  MapUse use = MapUse::colour;
  std::uint32_t picture = 0;

  bool operator==(const MaterialMap&) const = default;
};

/// A material as far as every format has a place for it.
struct Material {
  std::string name;
  std::array<float, 4> colour{1, 1, 1, 1};  // linear red, green, blue, and alpha, 0 to 1
  std::vector<MaterialMap> maps = {};       // by the triangles' texture coordinates
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;

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

/// The pictures that materials have, as whole files.
struct PictureFiles {
  std::vector<std::string> names;  // of files, with an extension that says what they are
  /// The bytes of one. Throws IoError, or DataError, if it cannot be read any more.
  std::function<std::string(std::size_t picture)> load;
};

}  // namespace meshfarm
