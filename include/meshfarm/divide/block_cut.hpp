// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/divide/weld_counts.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/bundles.hpp>
#include <meshfarm/io/mesh_blocks.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

// The cut of a mesh (cut.hpp) by blocks of its file, each step by itself, on any host. The parts
// and the boundary are those of cut_mesh() with Weld::exact, to the byte, however many blocks there
// are:
//   survey      a block of vertices: box
//   count       a block of vertices: how many lie in each cell
//   partition   all counts: what part each cell is of, or finer cells to count once more
//   scatter     a block of vertices, then a block of triangles: a bundle each, a section a part
//   build       a part, of its sections
//   join        a group of regions (regions.hpp): its boundary, of what parts tell of their
//   boundary
//               vertices

struct BlockSurvey {
  Box box;
  std::uint64_t not_finite = 0;  // vertices with a coordinate that is not
};
BlockSurvey survey_block(const MeshBlocks& mesh, const BlockRange& vertices);

/// The cells of a mesh, before its vertices are counted.
std::string begin_cells(const Box& box, std::uint32_t parts);
/// What of the vertices lies in these cells.
std::string count_block(std::string_view cells, const MeshBlocks& mesh, const BlockRange& vertices);

struct Partition {
  std::string bytes;  // the cells to count once more, or which part each is of
  bool counts_again = false;
  std::uint32_t parts = 0;  // once it is known
};
/// What count_block() told of one of the blocks.
using CountedBlock = std::function<std::string(std::size_t)>;
/// `counted` is asked once for each block; their order does not matter.
Partition partition_blocks(std::string_view cells, std::size_t blocks, const CountedBlock& counted,
                           unsigned threads);

using WriteBytes = std::function<void(std::string_view)>;

/// `partition`: of partition_blocks().
VertexBundle scatter_vertices(std::string_view partition, const MeshBlocks& mesh,
                              const BlockRange& vertices, const WriteBytes& write);
/// `bundles`: of all blocks of vertices. Those that a slice of the triangles touches are read once
/// for it; a slice is the larger the more they are. Memory: what is written, 8 bytes a vertex of
/// one block, and 12 bytes a vertex of those touched, but no more than 24 bytes a triangle.
TriangleBundle scatter_triangles(const Stage& stage, std::span<const VertexBundleRef> bundles,
                                 std::uint32_t parts, const MeshBlocks& mesh,
                                 const BlockRange& triangles, const WriteBytes& write);

/// A part as the cut makes it, and what it came from.
struct PartOfBlocks : WeldCounts {
  Part part;
  std::uint64_t shared_triangles = 0;  // before any were dropped
  std::uint32_t shared_boundary = 0;   // boundary vertices, before any were welded
  std::string numbers;                 // of the boundary vertices: what join_boundary() wants
};
PartOfBlocks build_from_blocks(const Stage& stage, const BundlesOfMesh& bundles,
                               std::uint32_t part);

/// The part's surface alone, for those who measure to it: nothing is welded, which takes half of
/// the time. Its vertices are in the part's order.
Mesh surface_from_blocks(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t part);

struct JoinedBoundary {
  EncodedBoundary encoded;
  std::uint64_t triangles = 0;
  std::uint64_t degenerate = 0;  // that were dropped
  std::uint64_t coincident = 0;  // with two corners at one point, dropped or not
  std::uint64_t duplicate = 0;   // that were dropped
};
/// The boundary in a group of regions; those of all groups are what one cut would have made.
/// `numbers_of` is asked once for each part that has a corner there.
JoinedBoundary join_boundary(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t group,
                             const std::function<std::string(std::uint32_t part)>& numbers_of);

/// What cut_mesh() tells of these parts.
std::string partitioner_of_blocks();

}  // namespace meshfarm
