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

// What jobs make of the blocks of a mesh file (divide/block_cut.hpp): one staged file per block,
// with a section for each part that the block has data of.

/// The facts of a vertex bundle that are known without its file.
struct VertexBundle {
  FileSection directory;  // where each part's vertices are
  FileSection runs;       // the part of each vertex of the block, and its index there
  FileSection crowds;     // the first vertices at points that have too many
  std::uint64_t merged = 0;
  /// How many vertices it has of which parts, ascending by part; nothing if not recorded.
  struct OfPart {
    std::uint32_t part = 0;
    std::uint32_t count = 0;
    friend bool operator==(const OfPart&, const OfPart&) = default;
  };
  std::optional<std::vector<OfPart>> parts = {};
};
/// A bundle and its file. They are in the order of the blocks.
struct VertexBundleRef {
  FileRef file;
  VertexBundle bundle;
};

/// The same for a bundle of triangles.
struct TriangleBundle {
  FileSection directory;
  FileSection seams;                  // where the triangles between parts are, by group of regions
  std::uint64_t seam_triangles = 0;   // how many triangles lie between parts
  std::uint64_t dropped = 0;          // triangles that use a vertex without a position
  std::uint64_t points_left_out = 0;  // triangles whose corners are all one vertex
  FileSection vertices;               // which bundles hold all vertices of the mesh
  std::uint32_t groups = 0;           // the groups of regions that occur in `seams`, one bit each
  /// The parts that it has triangles of, ascending; nothing if not recorded.
  std::optional<std::vector<std::uint32_t>> parts = {};
};
struct TriangleBundleRef {
  FileRef file;
  TriangleBundle bundle;
};

/// All bundles of a mesh that was scattered.
struct BundlesOfMesh {
  PositionType positions = PositionType::float32;
  std::uint32_t parts = 0;
  std::vector<VertexBundleRef> vertices;
  std::vector<TriangleBundleRef> triangles;
};

/// The part of an entry of a bundle's list of parts.
inline std::uint32_t part_of(std::uint32_t part) {
  return part;
}
inline std::uint32_t part_of(const VertexBundle::OfPart& of) {
  return of.part;
}

/// The bundles that have, or may have, data of these parts. Their own lists of parts are left out.
BundlesOfMesh bundles_of_parts(const BundlesOfMesh& all, PartRange parts);
/// The bundles of triangles that have triangles between parts in this group of regions.
BundlesOfMesh bundles_of_group(const BundlesOfMesh& all, std::uint32_t group);

}  // namespace meshfarm
