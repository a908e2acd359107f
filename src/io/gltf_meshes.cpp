// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_meshes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <compare>
#include <string_view>
#include <system_error>
#include <utility>

#include "gltf_draco.hpp"

namespace meshfarm {
namespace {

constexpr std::array<std::string_view, 4> k_modes_without_triangles{"points", "lines", "line loops",
                                                                    "line strips"};
constexpr std::uint64_t k_index_uint16 = 5123;
constexpr std::uint64_t k_value_float = 5126;
constexpr std::uint64_t k_no_accessor = UINT64_MAX;

/// The accessors of a primitive's vertices.
struct Attributes {
  std::uint64_t positions = k_no_accessor;
  std::uint64_t normals = k_no_accessor;
  std::uint64_t colours = k_no_accessor;

  auto operator<=>(const Attributes&) const = default;
};

bool is_whole_number(PlyType type) {
  return type != PlyType::float32;
}

/// The type that an accessor's colours were made from, if it says so. All others count as 8 bits of
/// sRGB: programs mostly make linear colours of 16 bits and floats from these, and many read
/// nothing else from PLY.
ChannelType colour_type(const GltfValue& accessor) {
  const std::uint64_t type = accessor.at("componentType").whole();
  if (type != k_index_uint16 && type != k_value_float) return ChannelType::uint8;
  if (const auto extras = accessor.find("extras"); extras && extras->json().is_object()) {
    const nlohmann::json bits = extras->json().value(k_srgb_bits_extra, nlohmann::json());
    if (bits == 16) return ChannelType::uint16;
    if (bits == 32) return ChannelType::float32;
  }
  return ChannelType::uint8;
}

class MeshReader {
 public:
  MeshReader(const GltfValue& document, GltfBuffers& buffers, GltfSkipped& skipped)
      : document_(document), buffers_(buffers), skipped_(skipped) {}

  void add(const GltfValue& primitive, std::uint64_t number) {
    const std::uint64_t mode = primitive.whole_or("mode", 4);
    if (mode > 6) primitive.at("mode").fail("is not from 0 to 6");
    if (mode < 4) return skip(std::string(k_modes_without_triangles[mode]));
    const GltfValue attributes = primitive.at("attributes");
    if (!attributes.find("POSITION")) return skip("primitives without positions");
    GltfTriangles triangles{
        .place = primitive.place(), .primitive = number, .mode = static_cast<GltfMode>(mode)};
    // Draco data are always triangles, whatever they were made from.
    if (unpack_draco(document_, primitive, buffers_)) triangles.mode = GltfMode::triangles;
    triangles.vertices = vertices_of(attributes);
    triangles.material = primitive.whole_or("material", GltfTriangles::k_no_material);
    const std::uint64_t vertices = mesh_.vertices[triangles.vertices].positions.rows;
    triangles.corners = vertices;
    if (const auto indices = primitive.find("indices")) {
      triangles.indices = open_indices(*indices);
      triangles.corners = triangles.indices->rows;
    }
    if (triangles.mode == GltfMode::triangles && triangles.corners % 3 != 0) {
      primitive.fail("has " + std::to_string(triangles.corners) +
                     " corners of triangles, which is no multiple of three");
    }
    if (primitive.size_of("targets") > 0) skip("morph targets");
    mesh_.triangle_count += triangles.count();
    mesh_.triangles.push_back(std::move(triangles));
  }

  GltfMesh take() { return std::move(mesh_); }

 private:
  void skip(const std::string& what) { ++skipped_[what]; }

  std::size_t vertices_of(const GltfValue& attributes) {
    Attributes wanted{.positions = attributes.at("POSITION").whole()};
    for (const auto& [name, index] : attributes.json().items()) {
      if (name == "POSITION") continue;
      if (name == "NORMAL") {
        wanted.normals = attributes.at(name).whole();
      } else if (name == "COLOR_0") {
        wanted.colours = attributes.at(name).whole();
      } else {
        const std::string text = shown(name);  // in quotes
        skip(text.substr(1, text.size() - 2));
      }
    }
    const auto [found, is_new] = known_.emplace(wanted, mesh_.vertices.size());
    if (is_new) add_vertices(wanted, attributes);
    return found->second;
  }

  void add_vertices(const Attributes& wanted, const GltfValue& attributes) {
    GltfVertices made{.positions = open_column(document_, wanted.positions, buffers_),
                      .first = mesh_.vertex_count};
    const std::uint64_t rows = made.positions.rows;
    const auto open = [&](const char* name, std::uint64_t accessor) {
      GltfColumn column = open_column(document_, accessor, buffers_);
      if (column.rows != rows) {
        attributes.at(name).fail("has " + std::to_string(column.rows) + " elements, POSITION " +
                                 std::to_string(rows));
      }
      return column;
    };
    if (made.positions.components != 3 || made.positions.type == PlyType::uint32) {
      attributes.at("POSITION").fail("is not of three floats, or whole numbers of 8 or 16 bits");
    }
    if (wanted.normals != k_no_accessor) {
      made.normals = open("NORMAL", wanted.normals);
      if (made.normals->components != 3) attributes.at("NORMAL").fail("is not of VEC3");
    }
    if (wanted.colours != k_no_accessor) {
      made.colours = open("COLOR_0", wanted.colours);
      if (made.colours->components < 3) attributes.at("COLOR_0").fail("is not of VEC3 or VEC4");
      made.colours->normalized = is_whole_number(made.colours->type);
      made.colour_type = colour_type(document_.at("accessors").item(wanted.colours));
    }
    mesh_.vertex_count += rows;
    mesh_.vertices.push_back(std::move(made));
  }

  GltfColumn open_indices(const GltfValue& indices) {
    GltfColumn column = open_column(document_, indices.whole(), buffers_);
    const bool is_index = column.type == PlyType::uint8 || column.type == PlyType::uint16 ||
                          column.type == PlyType::uint32;
    if (column.components != 1 || !is_index) {
      indices.fail("is not of single whole numbers without a sign");
    }
    return column;
  }

  const GltfValue& document_;
  GltfBuffers& buffers_;
  GltfSkipped& skipped_;
  std::map<Attributes, std::size_t> known_;
  GltfMesh mesh_;
};

/// Whether the extension is supported, or does not affect what is read here.
bool is_known(std::string_view extension) {
  static constexpr std::array<std::string_view, 9> k_starts{"KHR_draco_mesh_compression",
                                                            "KHR_mesh_quantization",
                                                            "EXT_meshopt_compression",
                                                            "KHR_materials_",
                                                            "KHR_texture_",
                                                            "KHR_lights_",
                                                            "EXT_texture_",
                                                            "MSFT_texture_",
                                                            "KHR_xmp"};
  return std::any_of(k_starts.begin(), k_starts.end(),
                     [&](std::string_view start) { return extension.starts_with(start); });
}

/// "2.1" as 2 and 1; nothing for an invalid version.
std::optional<std::pair<std::uint32_t, std::uint32_t>> parsed_version(std::string_view text) {
  std::pair<std::uint32_t, std::uint32_t> made;
  const char* const end = text.data() + text.size();
  const auto [point, error] = std::from_chars(text.data(), end, made.first);
  if (error != std::errc() || point == end || *point != '.') return std::nullopt;
  const auto [stop, minor_error] = std::from_chars(point + 1, end, made.second);
  if (minor_error != std::errc() || stop != end) return std::nullopt;
  return made;
}

}  // namespace

GltfMesh read_gltf_mesh(const GltfValue& document, std::uint64_t mesh, GltfBuffers& buffers,
                        GltfSkipped& skipped) {
  MeshReader reader(document, buffers, skipped);
  const GltfValue primitives = document.at("meshes").item(mesh).at("primitives");
  for (std::uint64_t i = 0; i < primitives.size(); ++i) reader.add(primitives.item(i), i);
  return reader.take();
}

void check_gltf(const GltfValue& document) {
  const GltfValue version = document.at("asset").at("version");
  if (!version.text().starts_with("2.")) version.fail(shown(version.text()) + " is not 2.0");
  if (const auto least = document.at("asset").find("minVersion")) {
    const auto number = parsed_version(least->text());
    if (!number) least->fail(shown(least->text()) + " is not a version");
    if (*number > std::pair(2U, 0U)) {
      least->fail(shown(least->text()) + " is needed to read the file, and meshfarm reads 2.0");
    }
  }
  const std::optional<GltfValue> extensions = document.find("extensionsRequired");
  for (std::uint64_t i = 0; extensions && i < extensions->size(); ++i) {
    const std::string& name = extensions->item(i).text();
    if (!is_known(name)) {
      extensions->item(i).fail(shown(name) + " is needed to read the file, and not known");
    }
  }
}

}  // namespace meshfarm
