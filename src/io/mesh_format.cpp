// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/gltf_reader.hpp"
#include "io/mesh_writers.hpp"
#include "io/obj_reader.hpp"
#include "io/ply_reader.hpp"
#include "io/stl_reader.hpp"

namespace meshfarm {
namespace {

bool keeps_any(std::span<const Channel> /*all*/, const Channel& /*channel*/) {
  return true;
}

bool keeps_colour(std::span<const Channel> all, const Channel& channel) {
  const auto columns = colour_columns(all);
  return columns && std::any_of(columns->begin(), columns->end(),
                                [&](std::size_t column) { return all[column] == channel; });
}

bool keeps_none(std::span<const Channel> /*all*/, const Channel& /*channel*/) {
  return false;
}

/// How much of the labels a format has a place for.
enum class KeptLabels : std::uint8_t { none, numbers, all };

constexpr std::array k_colour_maps = {MapUse::colour};
constexpr std::array k_obj_maps = {MapUse::colour, MapUse::normal, MapUse::emission};
constexpr std::array k_gltf_maps = {MapUse::colour, MapUse::normal, MapUse::metal_and_roughness,
                                    MapUse::occlusion, MapUse::emission};

/// A format with a second encoding has a second row, without a name. A row that is only for reading
/// has no extension. Formats recognised by content alone come before those that also depend on the
/// file name.
struct MeshFormat {
  std::string_view name;  // as shown to the user
  std::string_view extension;
  bool (*recognises)(const InputFile& file);  // by content
  std::unique_ptr<MeshSource> (*open)(InputFile file, const OpenOptions& options);
  std::unique_ptr<MeshSink> (*create)(const std::filesystem::path& path,
                                      const MeshSinkOptions& options);
  bool (*keeps)(std::span<const Channel> all, const Channel& channel);  // when writing
  KeptLabels labels = KeptLabels::none;                                 // the same
  std::span<const MapUse> maps = {};  // of its pictures; none if it has no texture coordinates
};

constexpr std::array k_formats = {
    MeshFormat{"PLY", ".ply", is_ply_file, open_ply, create_ply, keeps_any, KeptLabels::numbers,
               k_colour_maps},
    MeshFormat{"GLB", ".glb", is_glb_file, open_glb, create_glb, is_gltf_channel, KeptLabels::all,
               k_gltf_maps},
    MeshFormat{"glTF", ".gltf", is_gltf_file, open_gltf, create_gltf, is_gltf_channel,
               KeptLabels::all, k_gltf_maps},
    MeshFormat{"OFF", ".off", is_off_file, open_off, create_off, keeps_colour},
    MeshFormat{"OBJ", ".obj", is_obj_file, open_obj, create_obj, keeps_colour, KeptLabels::all,
               k_obj_maps},
    MeshFormat{"STL", ".stl", is_ascii_stl_file, open_ascii_stl, create_stl, keeps_none},
    MeshFormat{"", "", is_binary_stl_file, open_binary_stl, nullptr, nullptr},
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// "a, b and c"
std::string listed(std::string_view MeshFormat::*what) {
  std::vector<std::string_view> words;
  for (const MeshFormat& format : k_formats) {
    if (!(format.*what).empty()) words.push_back(format.*what);
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

/// Null if there is none.
const MeshFormat* find_output_format(const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  if (extension.empty()) return k_formats.data();
  const auto* const found =
      std::find_if(k_formats.begin(), k_formats.end(),
                   [&](const MeshFormat& format) { return format.extension == extension; });
  return found == k_formats.end() ? nullptr : found;
}

}  // namespace

std::unique_ptr<MeshSource> open_mesh(const std::filesystem::path& path,
                                      const OpenOptions& options) {
  InputFile file(path);
  for (const MeshFormat& format : k_formats) {
    if (format.recognises(file)) return format.open(std::move(file), options);
  }
  if (file.size() == 0) throw DataError(path.string() + ": is empty");
  throw DataError(path.string() + ": unknown format; meshfarm reads " + listed(&MeshFormat::name) +
                  ", plain or compressed with gzip or zstd");
}

bool is_output_format(const std::filesystem::path& path) {
  return find_output_format(path) != nullptr;
}

void check_output_format(const std::filesystem::path& path) {
  if (is_output_format(path)) return;
  throw DataError(path.string() + ": cannot write " + path.extension().string() +
                  "; meshfarm writes " + listed(&MeshFormat::extension) + ", not compressed");
}

std::vector<Channel> kept_channels(const std::filesystem::path& path,
                                   std::span<const Channel> channels) {
  check_output_format(path);
  const MeshFormat& format = *find_output_format(path);
  std::vector<Channel> kept;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(kept),
               [&](const Channel& channel) { return format.keeps(channels, channel); });
  return kept;
}

bool keeps_labels(const std::filesystem::path& path) {
  check_output_format(path);
  return find_output_format(path)->labels != KeptLabels::none;
}

bool keeps_materials(const std::filesystem::path& path) {
  check_output_format(path);
  return find_output_format(path)->labels == KeptLabels::all;
}

bool keeps_uvs(const std::filesystem::path& path) {
  check_output_format(path);
  return !find_output_format(path)->maps.empty();
}

bool keeps_map(const std::filesystem::path& path, MapUse use) {
  check_output_format(path);
  const std::span<const MapUse> maps = find_output_format(path)->maps;
  return std::find(maps.begin(), maps.end(), use) != maps.end();
}

bool keeps_doubles(const std::filesystem::path& path) {
  check_output_format(path);
  const auto create = find_output_format(path)->create;
  return create != create_glb && create != create_gltf && create != create_stl;
}

bool has_packing(const std::filesystem::path& path) {
  check_output_format(path);
  return find_output_format(path)->create == create_glb;
}

std::unique_ptr<MeshSink> create_mesh(const std::filesystem::path& path,
                                      const MeshSinkOptions& options) {
  check_output_format(path);
  return find_output_format(path)->create(path, options);
}

void check_fits(const std::filesystem::path& path, const MeshSinkOptions& options) {
  check_output_format(path);
  if (find_output_format(path)->create == create_glb) check_fits_glb(path, options);
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, PositionType positions,
                const std::vector<Channel>& channels, std::span<const float> values,
                const std::optional<LabelMeaning>& labels, const PictureFiles& pictures) {
  write_mesh(MeshOutput{path}, mesh, positions, channels, values, labels, pictures);
}

void write_mesh(const MeshOutput& output, const Mesh& mesh, PositionType positions,
                const std::vector<Channel>& channels, std::span<const float> values,
                const std::optional<LabelMeaning>& labels, const PictureFiles& pictures) {
  MeshSinkOptions options{.vertices = mesh.positions.size(),
                          .triangles = mesh.triangles.size(),
                          .positions = positions,
                          .comment = {},
                          .channels = channels,
                          .packing = output.packing};
  if (!mesh.columns.labels.empty()) options.labels = labels ? labels : LabelMeaning{"label", {}};
  options.uvs = !mesh.columns.uvs.empty();
  options.pictures = pictures;
  const auto sink = create_mesh(output, options);
  sink->vertices(mesh.positions, values);
  sink->triangles(mesh.triangles, mesh.columns);
  sink->commit();
}

}  // namespace meshfarm
