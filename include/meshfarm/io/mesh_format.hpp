// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/mesh_sink.hpp>

namespace meshfarm {

/// Whether a file of this name can be written in the format of its extension: .ply, .glb, .gltf,
/// .off, .obj or .stl. A name without an extension is PLY.
bool is_output_format(const std::filesystem::path& path);

/// Throws DataError if not.
void check_output_format(const std::filesystem::path& path);

/// The channels that a file of this name has a place for. Throws as above.
std::vector<Channel> kept_channels(const std::filesystem::path& path,
                                   std::span<const Channel> channels);

/// Whether a file of this name has a place for triangles' labels. Throws as above.
bool keeps_labels(const std::filesystem::path& path);
/// Whether it also has a place for the names and colours of their materials.
bool keeps_materials(const std::filesystem::path& path);
/// Whether a file of this name has a place for triangles' texture coordinates, and for pictures.
bool keeps_uvs(const std::filesystem::path& path);
/// Whether it has a place for pictures of this use.
bool keeps_map(const std::filesystem::path& path, MapUse use);

/// Whether a file of this name keeps 64-bit positions exactly.
bool keeps_doubles(const std::filesystem::path& path);

/// Whether Packing changes a file of this name.
bool has_packing(const std::filesystem::path& path);

/// Where a mesh goes, and how.
struct MeshOutput {
  std::filesystem::path path;
  Packing packing = Packing::plain;

  operator const std::filesystem::path&() const { return path; }  // NOLINT: for who only names it
  std::string string() const { return path.string(); }
};

/// Throws UsageError for a GLB that is too large, as create_mesh() does, and DataError as above.
void check_fits(const std::filesystem::path& path, const MeshSinkOptions& options);

/// Begins a mesh file in the format of its extension. Throws DataError as above, IoError for a path
/// that cannot be written, and UsageError for more vertices or triangles than the format can count.
std::unique_ptr<MeshSink> create_mesh(const std::filesystem::path& path,
                                      const MeshSinkOptions& options);

/// Writes a whole mesh by create_mesh(), with its columns; labels without a meaning are only
/// numbers.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, PositionType positions,
                const std::vector<Channel>& channels = {}, std::span<const float> values = {},
                const std::optional<LabelMeaning>& labels = {}, const PictureFiles& pictures = {});
void write_mesh(const MeshOutput& output, const Mesh& mesh, PositionType positions,
                const std::vector<Channel>& channels = {}, std::span<const float> values = {},
                const std::optional<LabelMeaning>& labels = {}, const PictureFiles& pictures = {});

}  // namespace meshfarm
