// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

// What jobs make of blocks of a mesh's file (divide/block_cut.hpp): a staged file each, with a
// section for each part that the block has something of.

/// What is known of a bundle of vertices, beside its file.
struct VertexBundle {
  FileSection directory;  // which parts' vertices are where
  FileSection runs;       // the part of each vertex of the block, and its place there
  FileSection crowds;     // the first vertices at points that have too many
  std::uint64_t merged = 0;
  /// How many vertices of which parts it has, ascending by part; nothing if that is not told.
  struct OfPart {
    std::uint32_t part = 0;
    std::uint32_t count = 0;
    friend bool operator==(const OfPart&, const OfPart&) = default;
  };
  std::optional<std::vector<OfPart>> parts = {};
};
/// Which bundle lies where, in the order of the blocks.
struct VertexBundleRef {
  FileRef file;
  VertexBundle bundle;
};

/// What is known of a bundle of triangles.
struct TriangleBundle {
  FileSection directory;
  FileSection seams;                  // where those between parts are, by groups of regions
  std::uint64_t seam_triangles = 0;   // these are so many
  std::uint64_t dropped = 0;          // those that use a vertex without a position
  std::uint64_t points_left_out = 0;  // those whose corners are all one vertex
  FileSection vertices;               // which bundles all vertices of the mesh are in
  std::uint32_t groups = 0;           // of regions that `seams` has some of: a bit each
  /// The parts that it has triangles of, ascending; nothing if that is not told.
  std::optional<std::vector<std::uint32_t>> parts = {};
};
struct TriangleBundleRef {
  FileRef file;
  TriangleBundle bundle;
};

/// All of a mesh that was scattered.
struct BundlesOfMesh {
  PositionType positions = PositionType::float32;
  std::uint32_t parts = 0;
  std::vector<VertexBundleRef> vertices;
  std::vector<TriangleBundleRef> triangles;
};

/// Of an entry of what a bundle tells that it has.
inline std::uint32_t part_of(std::uint32_t part) {
  return part;
}
inline std::uint32_t part_of(const VertexBundle::OfPart& of) {
  return of.part;
}

/// Those bundles that have something of these parts, or may have; they do not tell what.
BundlesOfMesh bundles_of_parts(const BundlesOfMesh& all, PartRange parts);
/// Those bundles of triangles that have some between parts in this group of regions.
BundlesOfMesh bundles_of_group(const BundlesOfMesh& all, std::uint32_t group);

}  // namespace meshfarm
