// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/labels.hpp>

#include "gltf_column.hpp"
#include "gltf_json.hpp"

namespace meshfarm {

/// Vertices that one or more primitives of a mesh use.
struct GltfVertices {
  GltfColumn positions;
  std::optional<GltfColumn> normals;
  std::optional<GltfColumn> colours;
  ChannelType colour_type = ChannelType::uint8;  // holds their values
  std::uint64_t first = 0;                       // index among the mesh's
  std::uint64_t texture_colours = 0;             // index of their first: see sample_gltf_textures()
};

/// A column of texture coordinates and their transform: (u, v) becomes
/// (u a[0] + v a[1] + a[2], u b[0] + v b[1] + b[2]).
struct GltfUvs {
  GltfColumn column;
  std::array<double, 3> a{1, 0, 0};
  std::array<double, 3> b{0, 1, 0};
  bool are_finite = false;  // what is not finite becomes 0
};

enum class GltfMode : std::uint8_t { triangles = 4, strip = 5, fan = 6 };

/// The triangles of a primitive.
struct GltfTriangles {
  static constexpr std::uint64_t k_no_material = UINT64_MAX;

  std::string place;            // for messages
  std::uint64_t primitive = 0;  // index among the mesh's
  GltfMode mode = GltfMode::triangles;
  std::size_t vertices = 0;  // index in GltfMesh::vertices
  std::optional<GltfColumn> indices;
  std::uint64_t corners = 0;
  std::uint64_t material = k_no_material;  // of the document
  Label label = 0;                         // see label_gltf_meshes()
  std::optional<GltfUvs> uvs;              // see keep_gltf_maps()

  std::uint64_t count() const {
    if (mode == GltfMode::triangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
  }
};

struct GltfMesh {
  std::vector<GltfVertices> vertices;
  std::vector<GltfTriangles> triangles;
  std::uint64_t vertex_count = 0;
  std::uint64_t triangle_count = 0;
};

/// What is left out of the meshes: its name, and the number of primitives.
using GltfSkipped = std::map<std::string, std::uint64_t>;

/// A mesh of the document; primitives with the same attributes share their vertices. Throws
/// DataError with the place for malformed input.
GltfMesh read_gltf_mesh(const GltfValue& document, std::uint64_t mesh, GltfBuffers& buffers,
                        GltfSkipped& skipped);

/// Refuses a document that requires an unknown extension, that has another version than 2, or that
/// requires a reader of a later version than 2.0.
void check_gltf(const GltfValue& document);

}  // namespace meshfarm
