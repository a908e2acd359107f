// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include <meshfarm/io/mesh_sink.hpp>

namespace meshfarm {

/// A binary STL. Coordinates are rounded to float, whatever `positions` says. Normals are those of
/// the triangles, or zero where one has no area. More than 2^32 - 1 triangles are a UsageError: the
/// file's count has 32 bits. Positions are kept in a KeptPositions.
std::unique_ptr<MeshSink> create_stl(const std::filesystem::path& path,
                                     const MeshSinkOptions& options);

/// An OBJ with positions and triangles, with the fewest digits that give the same floats or
/// doubles. Labels, and texture coordinates with their pictures, are written as obj_labels.hpp
/// describes.
std::unique_ptr<MeshSink> create_obj(const std::filesystem::path& path,
                                     const MeshSinkOptions& options);

/// A .glb with one mesh. Positions are floats; doubles are made relative to the first, which
/// becomes the node's translation. Normals are normalised. Colours of 8 bits become 16 linear bits,
/// others floats. Pictures are embedded. More than 4 GiB are a UsageError.
std::unique_ptr<MeshSink> create_glb(const std::filesystem::path& path,
                                     const MeshSinkOptions& options);
/// Throws the UsageError of create_glb().
void check_fits_glb(const std::filesystem::path& path, const MeshSinkOptions& options);
/// The same as a .gltf with, beside it, a .bin of the same name, which is replaced, too, and the
/// pictures. 2^32 vertices or more are a UsageError.
std::unique_ptr<MeshSink> create_gltf(const std::filesystem::path& path,
                                      const MeshSinkOptions& options);
/// Whether both have a place for the channel: colours with their alpha, and normals.
bool is_gltf_channel(std::span<const Channel> all, const Channel& channel);

/// An ascii OFF, with digits as in the OBJ.
std::unique_ptr<MeshSink> create_off(const std::filesystem::path& path,
                                     const MeshSinkOptions& options);

}  // namespace meshfarm
