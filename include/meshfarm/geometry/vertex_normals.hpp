// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// The normal of each vertex, of length 1: the mean of its triangles' normals, weighted by their
/// angles there (Thuermer & Wuethrich 1998), to 0.0001 radians. 0 where no triangle has an area.
std::vector<Vec3> vertex_normals(const Mesh& mesh);

}  // namespace meshfarm
