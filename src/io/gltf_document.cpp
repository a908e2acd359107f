// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "gltf_json.hpp"

namespace meshfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_float = 5126;
constexpr int k_uint16 = 5123;
constexpr int k_uint32 = 5125;

Json accessor(const GltfLayout& layout, std::size_t offset, int type, const char* shape) {
  return {{"bufferView", 0},
          {"byteOffset", offset},
          {"componentType", type},
          {"count", layout.vertices},
          {"type", shape}};
}

/// Accessors and what a primitive says of them.
void add_mesh(const GltfLayout& layout, const GltfBounds& bounds, std::string_view uri,
              Json& document) {
  Json attributes = {{"POSITION", 0}};
  Json accessors = Json::array({accessor(layout, 0, k_float, "VEC3")});
  accessors[0]["min"] = bounds.lo;
  accessors[0]["max"] = bounds.hi;
  if (layout.normals) {
    attributes["NORMAL"] = accessors.size();
    accessors.push_back(accessor(layout, 12, k_float, "VEC3"));
  }
  if (layout.colours) {
    const bool are_bytes = layout.colour_type == ChannelType::uint8;
    attributes["COLOR_0"] = accessors.size();
    accessors.push_back(accessor(layout, layout.vertex_bytes - layout.colour_bytes,
                                 are_bytes ? k_uint16 : k_float, layout.alpha ? "VEC4" : "VEC3"));
    if (are_bytes) accessors.back()["normalized"] = true;
    const int bits = layout.colour_type == ChannelType::uint16 ? 16 : 32;
    accessors.back()["extras"] = {{k_srgb_bits_extra, are_bytes ? 8 : bits}};
  }
  Json primitive = {{"attributes", attributes}};
  Json views = Json::array({{{"buffer", 0},
                             {"byteLength", layout.vertices_bytes()},
                             {"byteStride", layout.vertex_bytes},
                             {"target", 34962}}});
  if (layout.triangles > 0) {
    primitive["indices"] = accessors.size();
    accessors.push_back({{"bufferView", 1},
                         {"componentType", layout.index_bytes == 2 ? k_uint16 : k_uint32},
                         {"count", 3 * layout.triangles},
                         {"type", "SCALAR"}});
    views.push_back({{"buffer", 0},
                     {"byteOffset", layout.vertices_bytes()},
                     {"byteLength", layout.indices_bytes()},
                     {"target", 34963}});
  } else {
    primitive["mode"] = 0;  // points
  }
  primitive["material"] = 0;
  document["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
  // Else it would be taken for metal, which is black where nothing is around it.
  document["materials"] = Json::array({{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
  document["accessors"] = accessors;
  document["bufferViews"] = views;
  Json buffer = Json::object();
  if (!uri.empty()) buffer["uri"] = uri;
  buffer["byteLength"] = layout.binary_bytes();
  document["buffers"] = Json::array({buffer});
}

}  // namespace

GltfLayout::GltfLayout(const MeshSinkOptions& options)
    : vertices(options.vertices),
      triangles(options.triangles),
      normals(normal_columns(options.channels)),
      colours(colour_columns(options.channels)),
      alpha(alpha_column(options.channels)),
      vertex_bytes(12 + (normals ? 12 : 0)),
      // The largest number of a type would begin a strip.
      index_bytes(vertices <= UINT16_MAX ? 2 : 4) {
  if (!colours) return;
  const auto widen = [&](std::size_t column) {
    colour_type = std::max(colour_type, options.channels[column].type);
  };
  std::for_each(colours->begin(), colours->end(), widen);
  if (alpha) widen(*alpha);
  if (colour_type == ChannelType::uint8) {
    colour_bytes = 4 * sizeof(std::uint16_t);
  } else {
    colour_bytes = (alpha ? 4 : 3) * sizeof(float);
  }
  vertex_bytes += colour_bytes;
}

std::string gltf_document(const GltfLayout& layout, const GltfBounds& bounds,
                          std::string_view comment, std::string_view uri) {
  std::string generator = "meshfarm";
  if (!comment.empty()) generator += ": " + std::string(comment);
  Json document = {{"asset", {{"version", "2.0"}, {"generator", generator}}}, {"scene", 0}};
  if (layout.vertices == 0) {
    document["scenes"] = Json::array({Json::object()});
  } else {
    Json node = {{"mesh", 0}};
    if (bounds.translation) node["translation"] = *bounds.translation;
    document["scenes"] = Json::array({{{"nodes", {0}}}});
    document["nodes"] = Json::array({node});
    add_mesh(layout, bounds, uri, document);
  }
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace meshfarm
