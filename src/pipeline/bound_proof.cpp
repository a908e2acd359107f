// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bound_proof.hpp"

#include <utility>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/vertices.hpp>

namespace meshfarm {

std::uint32_t put_last(Mesh& mesh, const std::vector<std::uint8_t>& flags) {
  std::vector<std::uint32_t> number(flags.size());
  std::uint32_t next = 0;
  std::uint32_t first = 0;
  for (const std::uint8_t wanted : {std::uint8_t{0}, std::uint8_t{1}}) {
    for (std::uint32_t v = 0; v < flags.size(); ++v) {
      if (flags[v] == wanted) number[v] = next++;
    }
    if (wanted == 0) first = next;
  }
  Mesh ordered;
  place_vertices(VertexView(mesh), number, next, ordered);
  ordered.triangles = std::move(mesh.triangles);
  ordered.columns = std::move(mesh.columns);
  renumber_corners(ordered.triangles, number);
  mesh = std::move(ordered);
  return first;
}

BoundProof::BoundProof(Mesh surface, double distance, unsigned threads)
    : surface_(std::move(surface)), distance_(distance), threads_(threads) {
  drop_coincident_corners(surface_);
  if (!surface_.triangles.empty()) index_.emplace(surface_, threads);
}

bool BoundProof::holds_for(const Mesh& result) const {
  return is_near(result) && find_lost(result).empty();
}

bool BoundProof::is_near(const Mesh& result) const {
  if (!index_) return result.triangles.empty();
  return is_within(result, *index_, distance_, threads_);
}

std::vector<Triangle> BoundProof::find_lost(const Mesh& result) const {
  if (!index_ || result.triangles.empty()) return surface_.triangles;
  std::vector<Triangle> lost;
  const TriangleIndex to(result, threads_);
  for (const std::uint32_t i :
       find_beyond(surface_.positions, surface_.triangles, to, distance_, threads_)) {
    lost.push_back(surface_.triangles[i]);
  }
  return lost;
}

}  // namespace meshfarm
