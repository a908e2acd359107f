// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "gltf_corners.hpp"
#include "gltf_maps.hpp"
#include "gltf_materials.hpp"
#include "gltf_meshes.hpp"
#include "gltf_scene.hpp"
#include "gltf_textures.hpp"
#include "srgb.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_gltf_vertices = std::uint64_t{1} << 62;

/// The channels that exist; their values come in this order: normal, colour.
struct GltfChannels {
  bool normals = false;
  bool colours = false;
  bool alpha = false;
  ChannelType colour_type = ChannelType::uint8;

  std::size_t count() const { return (normals ? 3 : 0) + (colours ? 3 : 0) + (alpha ? 1 : 0); }
  std::vector<Channel> named() const {
    std::vector<Channel> made;
    const auto add = [&made](const char* name, ChannelType type, ChannelRole role) {
      made.push_back({name, type, role});
    };
    for (const char* name : {"nx", "ny", "nz"}) {
      if (normals) add(name, ChannelType::float32, ChannelRole::normal);
    }
    for (const char* name : {"red", "green", "blue"}) {
      if (colours) add(name, colour_type, ChannelRole::colour);
    }
    if (alpha) add("alpha", colour_type, ChannelRole::colour);
    return made;
  }
  double largest_level() const {
    if (colour_type == ChannelType::float32) return 1;
    return colour_type == ChannelType::uint8 ? UINT8_MAX : UINT16_MAX;
  }
};

class GltfSource final : public MeshSource {
 public:
  GltfSource(const InputFile& file, const GltfContainer& container, const OpenOptions& options)
      : place_(file.path().string() + ": ") {
    const nlohmann::json json =
        parse_gltf_json(container.json, container.json_start, file.path().string());
    const GltfValue document(json, place_);
    check_gltf(document);
    info_.format = container.format;
    info_.compression = name_of(file.compression());
    GltfBuffers buffers(file.path(), container.binary);
    GltfSkipped skipped;
    read_meshes(document, buffers, skipped);
    read_textures(document, buffers, options);
    if (options.labels && !texture_colours_) labels_ = label_gltf_meshes(document, meshes_);
    if (options.textures == Textures::keep) keep_maps(document, buffers);
    info_.labels = labels_.meaning;
    find_channels(options, skipped);
    skip_others(document, skipped);
    for (const auto& [what, count] : skipped) {
      info_.skipped.push_back(what + " (" + std::to_string(count) + ")");
    }
  }

  const MeshFileInfo& info() const override { return info_; }

  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    std::vector<Vec3> points;
    for_vertices([&](const GltfVertices& vertices, const GltfTransform& transform,
                     std::uint64_t first, std::size_t count) {
      read_points(vertices, transform, {first, count}, points);
      take(points);
    });
  }

  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    if (channels_.count() == 0) return;
    ChannelPoints batch;
    for_vertices([&](const GltfVertices& vertices, const GltfTransform& transform,
                     std::uint64_t first, std::size_t count) {
      const Rows rows{first, count};
      read_points(vertices, transform, rows, batch.points);
      batch.values.resize(count * channels_.count());
      std::size_t column = 0;
      if (channels_.normals) {
        read_normals(*vertices.normals, transform, rows, batch.values);
        column = 3;
      }
      if (channels_.colours) read_colours(vertices, column, rows, batch.values);
      take(batch);
    });
  }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    TriangleBatch batch(take);
    std::optional<GltfPlaces> places;
    if (info_.uvs) batch.keep_uvs();
    std::uint64_t first = 0;
    for (const GltfInstance& instance : instances_) {
      const GltfMesh& mesh = meshes_.at(instance.mesh);
      for (const GltfTriangles& triangles : mesh.triangles) {
        const GltfVertices& vertices = mesh.vertices[triangles.vertices];
        GltfCorners corners(triangles, first + vertices.first, instance.transform.is_mirror(),
                            batch);
        if (info_.labels) batch.label(triangles.label);
        if (triangles.uvs) {
          if (!places || !places->are_of(*triangles.uvs)) places.emplace(*triangles.uvs);
          corners.place(*places);
        }
        read_corners(triangles, vertices.positions.rows, corners);
      }
      first += mesh.vertex_count;
    }
    batch.flush();
  }

 private:
  struct Rows {
    std::uint64_t first = 0;
    std::size_t count = 0;
  };

  void read_meshes(const GltfValue& document, GltfBuffers& buffers, GltfSkipped& skipped) {
    GltfScene scene = read_gltf_scene(document);
    instances_ = std::move(scene.instances);
    if (scene.repeated > 0) skipped["EXT_mesh_gpu_instancing"] = scene.repeated;
    for (const GltfInstance& instance : instances_) {
      const auto [found, is_new] = meshes_.try_emplace(instance.mesh);
      if (is_new) found->second = read_gltf_mesh(document, instance.mesh, buffers, skipped);
      const GltfMesh& mesh = found->second;
      info_.vertices += mesh.vertex_count;
      info_.faces += mesh.triangle_count;
      if (std::max({info_.vertices, info_.faces, mesh.vertex_count, mesh.triangle_count}) >
          k_most_gltf_vertices) {
        throw DataError(place_ + "the nodes show more than 2^62 vertices or triangles");
      }
      for (const GltfVertices& vertices : mesh.vertices) {
        const bool is_exact = instance.transform.is_identity() && !vertices.positions.normalized;
        if (!is_exact) info_.positions = PositionType::float64;
      }
    }
  }

  void keep_maps(const GltfValue& document, GltfBuffers& buffers) {
    maps_ =
        keep_gltf_maps(document, buffers, meshes_, labels_, place_.substr(0, place_.size() - 2));
    info_.uvs = maps_.uvs;
    info_.pictures = std::move(maps_.pictures);
  }

  void read_textures(const GltfValue& document, GltfBuffers& buffers, const OpenOptions& options) {
    const bool are_read = options.textures == Textures::bake || options.textures == Textures::name;
    if (!are_read || !options.channels) return;
    if (options.textures == Textures::bake) {
      const auto scan = [this](const GltfTriangles& triangles, const GltfVertices& vertices,
                               const auto& take) {
        TriangleBatch batch(take);
        GltfCorners corners(triangles, 0, false, batch);
        read_corners(triangles, vertices.positions.rows, corners);
        batch.flush();
      };
      texture_colours_ =
          sample_gltf_textures(document, buffers, meshes_, place_.substr(0, place_.size() - 2),
                               scan, options.picture_bytes);
      if (!texture_colours_) return;
    }
    info_.textures = describe_gltf_textures(
        document, buffers, meshes_,
        options.textures == Textures::bake ? LostPictures::left : LostPictures::told);
  }

  /// Normals are used only if all vertices have them: interpolated with missing ones they mean
  /// nothing.
  void find_channels(const OpenOptions& options, GltfSkipped& skipped) {
    std::uint64_t with_normals = 0;
    std::uint64_t with_colours = 0;
    std::uint64_t all = 0;
    for (const auto& [number, mesh] : meshes_) {
      for (const GltfVertices& vertices : mesh.vertices) {
        ++all;
        with_normals += vertices.normals ? 1 : 0;
        with_colours += vertices.colours ? 1 : 0;
        channels_.colour_type = std::max(channels_.colour_type, vertices.colour_type);
        channels_.alpha |= vertices.colours && vertices.colours->components == 4;
      }
    }
    channels_.normals = options.channels && with_normals == all && all > 0;
    channels_.colours = options.channels && (with_colours > 0 || texture_colours_ != nullptr);
    channels_.alpha &= channels_.colours;
    if (!channels_.normals && with_normals > 0) skipped["NORMAL"] += with_normals;
    if (!channels_.colours && with_colours > 0) skipped["COLOR_0"] += with_colours;
    info_.channels = channels_.named();
  }

  void skip_others(const GltfValue& document, GltfSkipped& skipped) const {
    std::size_t materials = 0;
    for (std::size_t i = 0; i < document.size_of("materials"); ++i) {
      materials += is_plain_gltf_material(document.at("materials").item(i).json()) ? 0 : 1;
    }
    if (materials > labels_.materials) skipped["materials"] = materials - labels_.materials;
    const std::size_t sampled = texture_colours_ ? info_.textures.size() : 0;
    const auto skip_rest = [&](const char* name, std::size_t used) {
      const std::size_t count = document.size_of(name);
      if (count > used) skipped[name] += count - used;
    };
    skip_rest("textures", info_.uvs ? maps_.textures : sampled);
    skip_rest("images", info_.uvs ? info_.pictures.names.size() : sampled);
    for (const auto& [name, count] : maps_.skipped) skipped[name] += count;
    for (const auto& [name, count] : maps_.read) {
      if ((skipped[name] -= count) == 0) skipped.erase(name);
    }
    for (const char* name : {"skins", "animations"}) {
      if (const std::size_t count = document.size_of(name)) skipped[name] += count;
    }
    const std::size_t meshes = document.size_of("meshes");
    if (meshes > meshes_.size()) skipped["meshes outside the scene"] += meshes - meshes_.size();
  }

  /// Calls `use` with batches of rows for all vertices of all instances.
  template <class Use>
  void for_vertices(const Use& use) const {
    for (const GltfInstance& instance : instances_) {
      for (const GltfVertices& vertices : meshes_.at(instance.mesh).vertices) {
        const std::uint64_t rows = vertices.positions.rows;
        for (std::uint64_t first = 0; first < rows; first += GltfColumnReader::k_most_rows) {
          use(vertices, instance.transform, first,
              std::min<std::uint64_t>(rows - first, GltfColumnReader::k_most_rows));
        }
      }
    }
  }

  void read_rows(const GltfColumn& column, const Rows& rows) {
    rows_.resize(rows.count);
    reader_.read(column, rows.first, rows_);
  }

  void read_points(const GltfVertices& vertices, const GltfTransform& transform, const Rows& rows,
                   std::vector<Vec3>& points) {
    points.resize(rows.count);
    reader_.read(vertices.positions, rows.first, points);
    const bool stays = transform.is_identity();
    for (Vec3& p : points) {
      if (!stays) p = transform.of(p);
      if (!is_finite(p)) p = k_no_position;
    }
  }

  void read_normals(const GltfColumn& column, const GltfTransform& transform, const Rows& rows,
                    std::span<float> values) {
    read_rows(column, rows);
    float* value = values.data();
    for (const std::array<double, 4>& row : rows_) {
      Vec3 normal{row[0], row[1], row[2]};
      if (!transform.is_identity()) {
        normal = transform.of_normal(normal);
        const double size = length(normal);
        normal = size > 0 ? normal * (1 / size) : Vec3{};
      }
      value[0] = static_cast<float>(normal.x);
      value[1] = static_cast<float>(normal.y);
      value[2] = static_cast<float>(normal.z);
      value += channels_.count();
    }
  }

  /// Vertices without a colour are white. The colours of textures are multiplied by those of the
  /// vertices.
  void read_colours(const GltfVertices& vertices, std::size_t first, const Rows& rows,
                    std::span<float> values) {
    const double largest = channels_.largest_level();
    rows_.assign(rows.count, {1, 1, 1, 1});
    if (vertices.colours) reader_.read(*vertices.colours, rows.first, rows_);
    if (texture_colours_) multiply_by_textures(vertices.texture_colours + rows.first);
    float* value = values.data() + first;
    for (const std::array<double, 4>& row : rows_) {
      for (std::size_t i = 0; i < 3; ++i) {
        value[i] = static_cast<float>(largest * srgb_of_linear(row[i]));
      }
      if (channels_.alpha) {
        const double alpha = std::isfinite(row[3]) ? row[3] : 0;
        value[3] = static_cast<float>(largest * std::clamp(alpha, 0.0, 1.0));
      }
      value += channels_.count();
    }
  }

  void multiply_by_textures(std::uint64_t vertex) {
    for (std::array<double, 4>& row : rows_) {
      if (const std::optional<LinearColour> colour = texture_colours_->of(vertex)) {
        for (std::size_t i = 0; i < 3; ++i) row[i] *= static_cast<double>((*colour)[i]);
      }
      ++vertex;
    }
  }

  void read_corners(const GltfTriangles& triangles, std::uint64_t vertices, GltfCorners& corners) {
    if (!triangles.indices) {
      for (std::uint64_t i = 0; i < triangles.corners; ++i) corners.add(i);
      return;
    }
    for (std::uint64_t first = 0; first < triangles.corners;) {
      indices_.resize(
          std::min<std::uint64_t>(triangles.corners - first, GltfColumnReader::k_most_rows));
      reader_.read(*triangles.indices, first, indices_);
      check_indices(triangles, first, vertices);
      corners.add(std::span<const std::uint32_t>(indices_));
      first += indices_.size();
    }
  }

  void check_indices(const GltfTriangles& triangles, std::uint64_t first,
                     std::uint64_t vertices) const {
    std::uint32_t largest = 0;
    for (const std::uint32_t index : indices_) largest = std::max(largest, index);
    if (largest < vertices || indices_.empty()) return;
    const auto found = std::find_if(indices_.begin(), indices_.end(),
                                    [&](std::uint32_t index) { return index >= vertices; });
    const std::uint64_t at = first + static_cast<std::uint64_t>(found - indices_.begin());
    throw DataError(triangles.place + ": index " + std::to_string(at) + ": vertex " +
                    std::to_string(*found) + " is out of range: there are " +
                    std::to_string(vertices) + " vertices");
  }

  std::string place_;
  MeshFileInfo info_;
  GltfChannels channels_;
  std::vector<GltfInstance> instances_;
  GltfMeshes meshes_;
  GltfLabels labels_;
  GltfMaps maps_;
  std::unique_ptr<TextureColours> texture_colours_;
  GltfColumnReader reader_;
  std::vector<std::array<double, 4>> rows_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

std::unique_ptr<MeshSource> open_glb(InputFile file, const OpenOptions& options) {
  const auto shared = std::make_shared<const InputFile>(std::move(file));
  return std::make_unique<GltfSource>(*shared, open_glb_container(shared), options);
}

std::unique_ptr<MeshSource> open_gltf(InputFile file, const OpenOptions& options) {
  return std::make_unique<GltfSource>(file, open_gltf_container(file), options);
}

}  // namespace meshfarm
