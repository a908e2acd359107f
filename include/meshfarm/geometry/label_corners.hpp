// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// How many vertices stay where they are as long as labels are kept: those where more or fewer than
/// two edges lie between triangles of two labels, but at least one. No result has much fewer
/// vertices than these. Labels: one a triangle, or none.
std::uint64_t count_label_corners(std::span<const Triangle> triangles,
                                  std::span<const Label> labels, std::size_t vertices);

}  // namespace meshfarm
