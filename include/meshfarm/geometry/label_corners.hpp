// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// How many vertices cannot move as long as labels are kept: those with one, or more than two,
/// edges between triangles of different labels. No result has much fewer vertices than these.
/// Labels: one per triangle, or none.
std::uint64_t count_label_corners(std::span<const Triangle> triangles,
                                  std::span<const Label> labels, std::size_t vertices);

}  // namespace meshfarm
