// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// Scans the vertices, once or twice.
Box vertex_box(MeshSource& source);

/// Whether faces share so few vertices that corners may miss each other.
bool may_have_near_misses(const MeshFileInfo& info);

/// How far vertices of the mesh that belong together may be apart; 0 if they are at the same
/// position (see NearMisses). Scans the vertices, and in some cases the triangles. `box`: of all
/// vertices.
double find_near_misses(MeshSource& source, const Box& box);

struct NearMerging {
  double distance = 0;                        // above 0
  unsigned threads = 0;                       // 0: one per core, up to eight
  std::function<void(double)> progress = {};  // gets the part done; may throw
};

/// The same mesh with vertices moved onto others up to a distance away (see merge_near()), so that
/// they can be welded; info() says how many. Scans the vertices twice. Memory: about 100 MB, and
/// 160 MB per thread, or 160 bytes for each vertex on a plane across the longest side of the box,
/// if that is more. Scratch files without names in $TMPDIR (or /tmp) have up to 32 bytes per vertex
/// (of doubles: 56) during the call and 12 (24) afterwards. Throws IoError.
std::unique_ptr<MeshSource> with_near_merged(std::unique_ptr<MeshSource> source, const Box& box,
                                             const NearMerging& options);

}  // namespace meshfarm
