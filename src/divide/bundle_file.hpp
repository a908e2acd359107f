// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Bundles: what a block of a mesh holds of each part. Sections (staging/sections.hpp), little
// endian:
//   vertices:  directory = BundleEntry[], ascending by part; section = positions, 3 x f32 or f64
//              runs      = PlaceRun[], for all vertices of the block in order
//              crowds    = CrowdVertex[]
//   triangles: directory = BundleEntry[] of the triangles inside parts, ascending by part: packed
//              (io/packed_triangles.hpp) | of those at the part's seams: SeamTriangle[]
//              seams     = FileSection[], one per group of regions (block_cut.hpp): the triangles
//              between parts in its regions, as SeamTriangle[], in file order
//              vertices  = of each bundle of vertices in order: file | directory section
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

struct BundleEntry {
  std::uint32_t part = 0;
  std::uint32_t count = 0;  // of vertices, or triangles
  FileSection section;
  FileSection seams;  // of triangles: those at the part's seams
  static BundleEntry none(std::uint32_t part) { return {part, 0, {}, {}}; }
};
static_assert(sizeof(BundleEntry) == 56);

/// Consecutive vertices that go to one part, at consecutive places of the block's section; those of
/// MeshShares::k_no_share are dropped.
struct PlaceRun {
  std::uint32_t part = 0;
  std::uint32_t place = 0;
  std::uint32_t count = 0;
};

/// The first of a block's vertices at a point that has too many to keep.
struct CrowdVertex {
  std::uint32_t point = 0;  // its cell
  std::uint32_t part = 0;
  std::uint32_t place = 0;  // in the block's section
};

template <class T>
std::vector<T> read_section(const SectionedFile& file, const FileSection& section) {
  const std::string bytes = file.read(section);
  return ByteReader(bytes, "a section of a bundle").get_array<T>(bytes.size() / sizeof(T));
}

/// Where each part's vertices of each block begin in the part, when those of all blocks are
/// concatenated. Bundles that record their parts are opened on demand.
class BlockPlaces {
 public:
  /// Throws DataError if a part gets 2^32 vertices. `bundles` must outlive it.
  BlockPlaces(const Stage& stage, std::span<const VertexBundleRef> bundles, std::uint32_t parts);
  std::uint32_t first(std::size_t block, std::uint32_t part) const {
    return first_[block * parts_ + part];
  }
  /// The number of vertices of the part in the block.
  std::uint32_t count(std::size_t block, std::uint32_t part) const;
  /// The number in all blocks.
  std::uint32_t count(std::uint32_t part) const { return count_[part]; }
  std::vector<Vec3> positions(std::size_t block, std::uint32_t part, PositionType type);
  const SectionedFile& file(std::size_t block);
  std::size_t blocks() const { return bundles_.size(); }
  std::uint32_t parts() const { return parts_; }

 private:
  const std::vector<BundleEntry>& directory(std::size_t block);

  const Stage& stage_;
  std::span<const VertexBundleRef> bundles_;
  std::uint32_t parts_;
  std::vector<std::optional<SectionedFile>> files_;            // only those opened
  std::vector<std::optional<std::vector<BundleEntry>>> read_;  // directories
  std::vector<std::uint32_t> first_;                           // blocks x parts
  std::vector<std::uint32_t> count_;
};

/// Encoding of `vertices` in a bundle of triangles.
std::string encode_bundles(std::span<const VertexBundleRef> bundles);
std::vector<VertexBundleRef> decode_bundles(std::string_view bytes);

}  // namespace meshfarm
