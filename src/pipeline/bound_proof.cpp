// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bound_proof.hpp"

#include <utility>

#include <meshfarm/geometry/hausdorff.hpp>

namespace meshfarm {

BoundProof::BoundProof(Mesh surface, double distance, unsigned threads)
    : surface_(std::move(surface)), distance_(distance), threads_(threads) {
  drop_coincident_corners(surface_);
  if (!surface_.triangles.empty()) index_.emplace(surface_, threads);
}

bool BoundProof::holds_for(const Mesh& result) const {
  if (!index_ || result.triangles.empty()) return !index_ && result.triangles.empty();
  return is_within(result, *index_, distance_, threads_) &&
         is_within(surface_, TriangleIndex(result, threads_), distance_, threads_);
}

}  // namespace meshfarm
