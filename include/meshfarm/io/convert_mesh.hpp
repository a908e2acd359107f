// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <meshfarm/io/mesh_sink.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// What was written, and what was left out.
struct Converted {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  PositionType positions = PositionType::float32;  // as they were read
  std::vector<Channel> channels;                   // those the output has a place for
  bool has_labels = false;                         // whether written
  bool has_uvs = false;                            // whether written
  std::uint64_t small_faces = 0;                   // faces of fewer than three corners
  std::uint64_t dropped_not_finite = 0;            // triangles with a vertex without a position
};

/// Writes a mesh in the format of the output's extension, in memory that does not depend on its
/// size (except for one bit per vertex where some have no position). Vertices and triangles keep
/// their order, and nothing is merged; in GLB and glTF, triangles with labels are ordered by label.
/// `progress` gets the fraction done. Throws as open_mesh() and create_mesh() do.
Converted convert_mesh(MeshSource& source, const std::filesystem::path& output,
                       const std::function<void(double)>& progress,
                       Packing packing = Packing::plain);

}  // namespace meshfarm
