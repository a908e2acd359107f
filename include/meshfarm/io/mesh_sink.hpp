// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// How a GLB is written. Compressed: positions as 16-bit whole numbers where these are fine enough,
/// 8-bit normals, and everything through meshoptimizer's codecs. It is made in memory; a mesh too
/// large for that is written plain.
enum class Packing : std::uint8_t { plain, compressed };

struct MeshSinkOptions {
  std::uint64_t vertices = 0;  // exactly as many must be written
  std::uint64_t triangles = 0;
  PositionType positions = PositionType::float32;
  std::string comment;  // one line, may be empty; not every format has a place for it
  std::vector<Channel> channels = {};       // of the vertices; see kept_channels()
  std::optional<LabelMeaning> labels = {};  // of the triangles
  Packing packing = Packing::plain;         // for GLB only
  bool uvs = false;                         // whether triangles have texture coordinates
  PictureFiles pictures = {};               // of the labels' materials
};

/// A mesh file that is written in batches, in memory that does not depend on its size: all
/// vertices, then all triangles (but see Packing). It appears under its name only at commit(),
/// whole and synced; without commit() nothing is left behind.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  /// These throw IoError if something cannot be written, and DataError for more vertices or
  /// triangles than promised, and for an index out of range.
  virtual void vertices(std::span<const Vec3> batch) = 0;
  /// With the values of all channels: those of the first vertex, then those of the next.
  virtual void vertices(std::span<const Vec3> batch, std::span<const float> values) = 0;
  /// With exactly the columns that the options name.
  virtual void triangles(const TriangleView& batch) = 0;
  virtual void triangles(std::span<const Triangle> batch,
                         const TriangleColumnsView& columns = {}) = 0;
  /// Throws IoError if anything could not be written, DataError if the counts are not as promised.
  virtual void commit() = 0;
};

}  // namespace meshfarm
