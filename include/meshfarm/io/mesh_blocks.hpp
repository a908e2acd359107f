// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// Consecutive records.
struct BlockRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// The records of a block, where `records` records are divided into `blocks` blocks of equal size;
/// the last may have fewer.
BlockRange block_of(std::uint64_t records, std::uint64_t blocks, std::uint64_t block);

/// A mesh file whose records all have one size, so that any of them can be read directly. Gives the
/// same data as a scan of the MeshSource. Thread-safe.
class MeshBlocks {
 public:
  virtual ~MeshBlocks() = default;
  virtual std::uint64_t vertices() const = 0;
  virtual std::uint64_t triangles() const = 0;
  virtual PositionType positions() const = 0;
  /// In order, in batches. Throws DataError naming the place of what is malformed, IoError.
  virtual void scan_vertices(const BlockRange& range,
                             const std::function<void(std::span<const Vec3>)>& take) const = 0;
  virtual void scan_triangles(
      const BlockRange& range,
      const std::function<void(std::span<const WideTriangle>)>& take) const = 0;
};

/// For a plain binary PLY file of triangles that is as long as its header promises; null for any
/// other file. Throws IoError, and DataError for a malformed header.
std::unique_ptr<MeshBlocks> open_blocks(const std::filesystem::path& path);

}  // namespace meshfarm
