// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/mesh_sink.hpp>

namespace meshfarm {

/// Writes a binary little endian PLY. Indices are `int` up to 2^31 vertices, `uint` up to 2^32;
/// more is a UsageError (PLY has no wider index that readers accept).
std::unique_ptr<MeshSink> create_ply(const std::filesystem::path& path,
                                     const MeshSinkOptions& options);

void write_ply(const std::filesystem::path& path, const Mesh& mesh, PositionType positions);

}  // namespace meshfarm
