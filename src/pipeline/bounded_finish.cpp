// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_finish.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

#include "pipeline/bound_proof.hpp"

namespace meshfarm {
namespace {

/// Flags k_bounded_rings rings around the flagged vertices, and vertices without triangles, which
/// are to go.
std::vector<std::uint8_t> vertices_round(const Mesh& mesh, std::vector<std::uint8_t> near) {
  std::vector<std::uint8_t> flags;
  for (int ring = 0; ring < k_bounded_rings; ++ring) {
    flags = near;
    for (const auto& [a, b, c] : mesh.triangles) {
      if ((flags[a] | flags[b] | flags[c]) != 0) near[a] = near[b] = near[c] = 1;
    }
  }
  std::vector<std::uint8_t> used(near.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles) used[a] = used[b] = used[c] = 1;
  for (std::size_t v = 0; v < near.size(); ++v) {
    if (used[v] == 0) near[v] = 1;
  }
  return near;
}

/// Pieces of a part come in order, parts in any order.
Mesh input_near(const Stage& stage, const Manifest& manifest, const NearCells& near,
                unsigned threads) {
  std::vector<Mesh> of_part(manifest.parts.size() + 1);
  InputSurface input(stage, manifest, threads);
  input.show([&](const Box& box) { return near.touch(box); },
             [&](const SurfacePiece& piece) {
               add_near(piece.positions, piece.triangles, near, of_part[piece.part]);
             });
  Mesh all;
  for (Mesh& mesh : of_part) {
    append_surface(mesh.positions, mesh.triangles, all);
    mesh = {};
  }
  return all;
}

}  // namespace

BoundedFinish finish_to_bound(const Stage& stage, const Manifest& manifest, StitchedMesh stitched,
                              const BoundedFinishOptions& options) {
  SeamMesh seams;
  seams.mesh = std::move(stitched.mesh);
  std::vector<std::uint8_t> flags = std::move(stitched.seam);
  if (std::find(flags.begin(), flags.end(), 1) == flags.end()) return {std::move(seams.mesh)};
  flags = vertices_round(seams.mesh, std::move(flags));
  seams.locked = put_last(seams.mesh, flags);
  Mesh input = input_near(stage, manifest, cells_round_changes(seams, options), options.threads);
  if (input.triangles.empty()) return {std::move(seams.mesh)};
  return simplify_seams(std::move(seams), std::move(input), options);
}

}  // namespace meshfarm
