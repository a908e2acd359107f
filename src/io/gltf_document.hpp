// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/mesh_sink.hpp>

#include "gltf_surfaces.hpp"

namespace meshfarm {

/// The bytes of the one mesh that is written, according to the counts and the channels:
///   { vertex }, { triangle }, { zeros up to a multiple of 4, image }
///   vertex   = float x y z [float nx ny nz] [colour] [float u v], relative to the node's
///              translation; with texture coordinates, one for each of its wedges
///   colour   = uint16 r g b a, if all have 8 bits; else float r g b [a]. "extras" of the accessor
///              have the number of bits, so that they can be restored.
///   triangle = (uint16 | uint32) a b c; if they have labels, material by material
struct GltfLayout {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  bool uvs = false;
  std::optional<std::array<std::size_t, 3>> normals;  // indices among the channels
  std::optional<std::array<std::size_t, 3>> colours;
  std::optional<std::size_t> alpha;
  ChannelType colour_type = ChannelType::uint8;  // the finest of the components'
  std::size_t colour_bytes = 0;
  std::size_t vertex_bytes = 0;
  std::size_t index_bytes = 0;

  explicit GltfLayout(const MeshSinkOptions& options);
  void set_vertices(std::uint64_t count);

  std::size_t colour_at() const { return normals ? 24 : 12; }  // offset in a vertex
  std::size_t uv_at() const { return colour_at() + colour_bytes; }
  std::uint64_t vertices_bytes() const { return vertices * vertex_bytes; }
  std::uint64_t indices_bytes() const { return triangles * 3 * index_bytes; }
  std::uint64_t binary_bytes() const { return vertices_bytes() + indices_bytes(); }
};

/// Values that are known only at the end.
struct GltfBounds {
  std::optional<std::array<double, 3>> translation;
  std::array<double, 3> lo{};
  std::array<double, 3> hi{};
};

/// Consecutive triangles that share a material.
struct GltfPart {
  Material material;
  std::uint64_t triangles = 0;
};

struct GltfWords {
  std::string comment;
  std::string uri = {};              // of the file that is the buffer, if there is one
  std::vector<GltfPart> parts = {};  // cover all triangles; empty if they have no labels
  std::vector<GltfImage> images = {};

  /// Of those in the buffer, each with the zeros after it.
  std::uint64_t image_bytes() const;
};

/// Rounds up to a multiple of 4.
constexpr std::uint64_t padded_to_4(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

/// The JSON document of that mesh.
std::string gltf_document(const GltfLayout& layout, const GltfBounds& bounds,
                          const GltfWords& words);

}  // namespace meshfarm
