// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/triangle_index.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

TriangleIndex::TriangleIndex(const Mesh& mesh, unsigned threads)
    : mesh_(mesh), bvh_(std::make_unique<Bvh>(mesh, threads)) {}
TriangleIndex::~TriangleIndex() = default;
TriangleIndex::TriangleIndex(TriangleIndex&&) noexcept = default;

}  // namespace meshfarm
