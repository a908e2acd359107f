// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

/// Which vertices at the points of a share's boundary vertices stay apart, decided from all of
/// their triangles: those of the share and `outer`, the triangles between this share and others;
/// `position_of` returns the positions of their vertices. If no vertex has a twin, this only looks
/// at each position once.
std::vector<ApartVertex> find_apart(const MeshShare& share, std::uint32_t number,
                                    std::span<const SeamTriangle> outer,
                                    const std::function<Vec3(SharePlace)>& position_of);

inline constexpr std::uint32_t k_no_sheet = UINT32_MAX;
/// The sheet of a vertex; none for one that is merged with all others at its point.
std::uint32_t sheet_of(std::uint32_t place, std::span<const ApartVertex> apart);

}  // namespace meshfarm
