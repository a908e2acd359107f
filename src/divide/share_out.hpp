// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include <meshfarm/io/mesh_source.hpp>

#include "divide/mesh_shares.hpp"
#include "divide/share_map.hpp"
#include "divide/slab_map.hpp"

namespace meshfarm {

/// Told what is being scanned, and how many of all were seen; may be empty.
using ScanProgress =
    std::function<void(std::string_view phase, std::uint64_t done, std::uint64_t all)>;

/// The result of a first scan of the vertices.
struct VertexSurvey {
  PositionType positions = PositionType::float32;
  Box box;
  std::uint64_t vertices = 0;
  std::uint64_t not_finite = 0;  // vertices with a coordinate that is not finite
};

/// Scans all vertices, and again if positions turn out to be wider than expected. The probe, if
/// any, looks at them too.
VertexSurvey survey_vertices(MeshSource& source, OrderProbe* probe, const ScanProgress& tell);

/// The approximate number of triangles, before they are counted.
std::uint64_t likely_triangles(const MeshFileInfo& info);

/// Shows all vertices to the map until it is settled; returns the number of shares.
std::uint32_t settle(ShareMap& map, MeshSource& source, std::uint64_t vertices,
                     const ScanProgress& tell);

/// A mesh distributed to shares.
struct SharedMesh {
  std::unique_ptr<MeshShares> shares;
  std::uint64_t triangles = 0;  // of the input
};

/// Gives each vertex to the share from the settled map, then all triangles to their shares.
SharedMesh share_out(MeshSource& source, std::unique_ptr<ShareMap> map,
                     const MeshShares::Options& options, const ScanProgress& tell);

}  // namespace meshfarm
