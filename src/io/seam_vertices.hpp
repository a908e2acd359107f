// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/io/mesh_shares.hpp>

namespace meshfarm {

/// What stays apart of the vertices at the points of a share's boundary vertices, by all of their
/// triangles: those of the share and `outer`, the triangles between this share and others, whose
/// vertices `position_of` tells. Where no vertex has a twin it takes one look at each position.
std::vector<ApartVertex> find_apart(const MeshShare& share, std::uint32_t number,
                                    std::span<const SeamTriangle> outer,
                                    const std::function<Vec3(SharePlace)>& position_of);

}  // namespace meshfarm
