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

// The cut of a mesh (cut.hpp) by blocks of its file; each step can run on any host. Parts and
// boundary are byte for byte those of cut_mesh() with Weld::exact, whatever the number of blocks:
//   survey      a block of vertices: box
//   count       a block of vertices: how many lie in each cell
//   partition   all counts: the part of each cell, or finer cells to count again
//   scatter     a block of vertices, then a block of triangles: a bundle each, one section per part
//   build       a part, from its sections
//   join        a group of regions (regions.hpp): its boundary, from the parts' boundary vertices

struct BlockSurvey {
  Box box;
  std::uint64_t not_finite = 0;  // vertices with a coordinate that is not finite
};
BlockSurvey survey_block(const MeshBlocks& mesh, const BlockRange& vertices);

/// The cells of a mesh, before its vertices are counted.
std::string begin_cells(const Box& box, std::uint32_t parts);
/// Counts the vertices of a block in these cells.
std::string count_block(std::string_view cells, const MeshBlocks& mesh, const BlockRange& vertices);

struct Partition {
  std::string bytes;  // the cells to count again, or the part of each cell
  bool counts_again = false;
  std::uint32_t parts = 0;  // once the number is known
};
/// The output of count_block() for one of the blocks.
using CountedBlock = std::function<std::string(std::size_t)>;
/// `counted` is called once per block, in any order.
Partition partition_blocks(std::string_view cells, std::size_t blocks, const CountedBlock& counted,
                           unsigned threads);

using WriteBytes = std::function<void(std::string_view)>;

/// `partition`: from partition_blocks().
VertexBundle scatter_vertices(std::string_view partition, const MeshBlocks& mesh,
                              const BlockRange& vertices, const WriteBytes& write);
/// `bundles`: of all blocks of vertices. For each slice of the triangles, the bundles that it
/// touches are read once; the more bundles it touches, the larger the slice. Memory: the output, 8
/// bytes per vertex of one block, and 12 bytes per vertex of those touched, but at most 24 bytes
/// per triangle.
TriangleBundle scatter_triangles(const Stage& stage, std::span<const VertexBundleRef> bundles,
                                 std::uint32_t parts, const MeshBlocks& mesh,
                                 const BlockRange& triangles, const WriteBytes& write);

/// A part as the cut makes it, and facts about its input.
struct PartOfBlocks : WeldCounts {
  Part part;
  std::uint64_t shared_triangles = 0;  // before any were dropped
  std::uint32_t shared_boundary = 0;   // boundary vertices, before any were welded
  std::string numbers;                 // of the boundary vertices: the input of join_boundary()
};
PartOfBlocks build_from_blocks(const Stage& stage, const BundlesOfMesh& bundles,
                               std::uint32_t part);

/// The part's surface only, to measure to: nothing is welded, as welding takes half of the time.
/// Its vertices are in the part's order.
Mesh surface_from_blocks(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t part);

struct JoinedBoundary {
  EncodedBoundary encoded;
  std::uint64_t triangles = 0;
  std::uint64_t degenerate = 0;  // dropped ones
  std::uint64_t coincident = 0;  // with two corners at one point, dropped or not
  std::uint64_t duplicate = 0;   // dropped ones
};
/// The boundary in a group of regions; those of all groups are what a single cut would have made.
/// `numbers_of` is called once for each part that has a corner there.
JoinedBoundary join_boundary(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t group,
                             const std::function<std::string(std::uint32_t part)>& numbers_of);

/// What cut_mesh() records about the partitioner.
std::string partitioner_of_blocks();

}  // namespace meshfarm
