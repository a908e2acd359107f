// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

struct PlyWriterOptions {
  std::uint64_t vertices = 0;  // exactly as many must be written
  std::uint64_t triangles = 0;
  PositionType positions = PositionType::float32;
  std::string comment;  // one line, may be empty
};

/// Writes a binary little endian PLY through a bounded buffer: all vertices, then all triangles.
/// Indices are `int` up to 2^31 vertices, `uint` up to 2^32; more is a UsageError (PLY has no wider
/// index that readers take). The file appears under its name only at commit(), whole and synced.
class PlyWriter {
 public:
  PlyWriter(const std::filesystem::path& path, const PlyWriterOptions& options);
  ~PlyWriter();  // without commit(): nothing is left behind
  void vertices(std::span<const Vec3> batch);
  void triangles(std::span<const WideTriangle> batch);
  void triangles(std::span<const Triangle> batch);
  /// Throws IoError if anything could not be written, DataError if the counts are not as promised.
  void commit();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

void write_ply(const std::filesystem::path& path, const Mesh& mesh, PositionType positions);

}  // namespace meshfarm
