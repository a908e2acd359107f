// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "gltf_json.hpp"
#include "mesh_writers.hpp"

namespace meshfarm {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int k_float = 5126;
constexpr int k_uint16 = 5123;
constexpr int k_uint32 = 5125;

OrderedJson accessor(const GltfLayout& layout, std::size_t offset, int type, const char* shape) {
  return {{"bufferView", 0},
          {"byteOffset", offset},
          {"componentType", type},
          {"count", layout.vertices},
          {"type", shape}};
}

/// Adds the accessors of the vertices. Returns a primitive's attributes, which name them.
OrderedJson add_vertices(const GltfLayout& layout, const GltfBounds& bounds,
                         OrderedJson& accessors) {
  OrderedJson attributes = {{"POSITION", 0}};
  accessors = OrderedJson::array({accessor(layout, 0, k_float, "VEC3")});
  accessors[0]["min"] = bounds.lo;
  accessors[0]["max"] = bounds.hi;
  if (layout.normals) {
    attributes["NORMAL"] = accessors.size();
    accessors.push_back(accessor(layout, 12, k_float, "VEC3"));
  }
  if (layout.colours) {
    const bool are_bytes = layout.colour_type == ChannelType::uint8;
    attributes["COLOR_0"] = accessors.size();
    accessors.push_back(accessor(layout, layout.colour_at(), are_bytes ? k_uint16 : k_float,
                                 layout.alpha ? "VEC4" : "VEC3"));
    if (are_bytes) accessors.back()["normalized"] = true;
    const int bits = layout.colour_type == ChannelType::uint16 ? 16 : 32;
    accessors.back()["extras"] = {{k_srgb_bits_extra, are_bytes ? 8 : bits}};
  }
  if (layout.uvs) {
    attributes["TEXCOORD_0"] = accessors.size();
    accessors.push_back(accessor(layout, layout.uv_at(), k_float, "VEC2"));
  }
  return attributes;
}

/// The accessor of the indices of some triangles.
OrderedJson index_accessor(const GltfLayout& layout, std::uint64_t first, std::uint64_t count) {
  OrderedJson made = {{"bufferView", 1}};
  if (first > 0) made["byteOffset"] = 3 * first * layout.index_bytes;
  made["componentType"] = layout.index_bytes == 2 ? k_uint16 : k_uint32;
  made["count"] = 3 * count;
  made["type"] = "SCALAR";
  return made;
}

/// The primitives, one per part, with their accessors and materials.
OrderedJson add_primitives(const GltfLayout& layout, const GltfWords& words,
                           const OrderedJson& attributes, OrderedJson& document) {
  constexpr std::size_t k_first_image_view = 2;
  GltfSurfaces surfaces(words.images);
  OrderedJson primitives = OrderedJson::array();
  std::uint64_t first = 0;
  for (const GltfPart& part : words.parts) {
    primitives.push_back({{"attributes", attributes},
                          {"indices", document["accessors"].size()},
                          {"material", primitives.size()}});
    document["accessors"].push_back(index_accessor(layout, first, part.triangles));
    document["materials"].push_back(surfaces.material(part.material));
    first += part.triangles;
  }
  surfaces.finish(k_first_image_view, document);
  return primitives;
}

void add_mesh(const GltfLayout& layout, const GltfBounds& bounds, const GltfWords& words,
              OrderedJson& document) {
  OrderedJson accessors;
  const OrderedJson attributes = add_vertices(layout, bounds, accessors);
  OrderedJson primitive = {{"attributes", attributes}};
  OrderedJson views = OrderedJson::array({{{"buffer", 0},
                                           {"byteLength", layout.vertices_bytes()},
                                           {"byteStride", layout.vertex_bytes},
                                           {"target", 34962}}});
  if (layout.triangles > 0) {
    primitive["indices"] = accessors.size();
    if (words.parts.empty()) accessors.push_back(index_accessor(layout, 0, layout.triangles));
    views.push_back({{"buffer", 0},
                     {"byteOffset", layout.vertices_bytes()},
                     {"byteLength", layout.indices_bytes()},
                     {"target", 34963}});
  } else {
    primitive["mode"] = 0;  // points
  }
  primitive["material"] = 0;
  document["meshes"] = OrderedJson::array({{{"primitives", OrderedJson::array({primitive})}}});
  // Otherwise it would count as metal, which is black in empty surroundings.
  document["materials"] = OrderedJson::array({{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
  document["accessors"] = accessors;
  if (!words.parts.empty()) {
    document["materials"] = OrderedJson::array();
    document["meshes"][0]["primitives"] = add_primitives(layout, words, attributes, document);
  }
  std::uint64_t end = layout.binary_bytes();
  for (const GltfImage& image : words.images) {
    if (!image.uri.empty()) continue;
    const std::uint64_t first = padded_to_4(end);
    views.push_back({{"buffer", 0}, {"byteOffset", first}, {"byteLength", image.bytes}});
    end = first + image.bytes;
  }
  document["bufferViews"] = views;
  OrderedJson buffer = OrderedJson::object();
  if (!words.uri.empty()) buffer["uri"] = words.uri;
  buffer["byteLength"] = end;
  document["buffers"] = OrderedJson::array({buffer});
}

}  // namespace

GltfLayout::GltfLayout(const MeshSinkOptions& options)
    : triangles(options.triangles),
      uvs(options.uvs),
      normals(normal_columns(options.channels)),
      colours(colour_columns(options.channels)),
      alpha(alpha_column(options.channels)),
      vertex_bytes(12 + (normals ? 12 : 0) + (uvs ? sizeof(Uv) : 0)) {
  set_vertices(options.vertices);
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

void GltfLayout::set_vertices(std::uint64_t count) {
  vertices = count;
  index_bytes = vertices <= UINT16_MAX ? 2 : 4;  // the largest number would restart a strip
}

std::uint64_t GltfWords::image_bytes() const {
  std::uint64_t sum = 0;
  for (const GltfImage& image : images) sum += image.uri.empty() ? padded_to_4(image.bytes) : 0;
  return sum;
}

std::string gltf_document(const GltfLayout& layout, const GltfBounds& bounds,
                          const GltfWords& words) {
  std::string generator = "meshfarm";
  if (!words.comment.empty()) generator += ": " + words.comment;
  OrderedJson document = {{"asset", {{"version", "2.0"}, {"generator", generator}}}, {"scene", 0}};
  if (layout.vertices == 0) {
    document["scenes"] = OrderedJson::array({OrderedJson::object()});
  } else {
    OrderedJson node = {{"mesh", 0}};
    if (bounds.translation) node["translation"] = *bounds.translation;
    document["scenes"] = OrderedJson::array({{{"nodes", {0}}}});
    document["nodes"] = OrderedJson::array({node});
    add_mesh(layout, bounds, words, document);
  }
  return document.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

bool is_gltf_channel(std::span<const Channel> all, const Channel& channel) {
  const auto is_any_of = [&](const std::optional<std::array<std::size_t, 3>>& columns) {
    return columns && std::any_of(columns->begin(), columns->end(),
                                  [&](std::size_t column) { return all[column] == channel; });
  };
  const std::optional<std::size_t> alpha = alpha_column(all);
  return is_any_of(normal_columns(all)) || is_any_of(colour_columns(all)) ||
         (alpha && all[*alpha] == channel);
}

}  // namespace meshfarm
