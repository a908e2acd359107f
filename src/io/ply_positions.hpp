// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "byte_stream.hpp"
#include "kept_positions.hpp"
#include "ply_binary_records.hpp"
#include "ply_header.hpp"

namespace meshfarm {

/// Looks up single vertices in a file of records of one size, through a small cache of blocks, of 1
/// MB. For polygons, whose corners are mostly near each other.
class PlyPositions {
 public:
  /// In the mesh file itself, which must outlive this. Null if the file offsets of its vertices are
  /// not known.
  static std::unique_ptr<PlyPositions> in_file(const InputFile& file, const PlyHeader& header);
  /// In the scratch file of the kept positions, which must outlive this.
  static std::unique_ptr<PlyPositions> in_scratch(const KeptPositions& kept);

  Vec3 at(std::uint64_t vertex);

 private:
  using Read = std::function<void(std::uint64_t offset, std::span<char> out)>;
  struct Block {
    std::uint64_t number = UINT64_MAX;
    std::vector<char> bytes;
  };
  struct Place {
    VertexLayout layout;
    PlyFormat format = PlyFormat::binary_little;
    std::uint64_t start = 0;
    std::uint64_t count = 0;
  };
  PlyPositions(Read read, const Place& place);

  static constexpr std::size_t k_blocks = 64;
  static constexpr std::size_t k_block_bytes = std::size_t{16} << 10;
  Read read_;
  Place place_;
  std::uint64_t records_a_block_;
  std::vector<Block> blocks_;
};

}  // namespace meshfarm
