// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/fill.hpp>

namespace meshfarm {

/// A corner of a boundary triangle: a vertex by its part and its index there.
struct BoundaryCorner {
  std::uint32_t part = 0;
  std::uint32_t local = 0;
  friend auto operator<=>(const BoundaryCorner&, const BoundaryCorner&) = default;
};
using BoundaryTriangle = std::array<BoundaryCorner, 3>;

/// Keeps the first of the triangles that have the same corners, in any order; of their
/// columns those of the triangles that stay. Returns how many were removed.
std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns);
std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles);

/// The side file: every triangle whose corners lie in two or three parts
/// (Xiong et al. 2008, 3.1 step 4), and their columns.
std::string encode_boundary(const std::vector<BoundaryTriangle>& triangles,
                            const TriangleColumnsView& columns = {});
std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what);
/// With the columns that the file has.
std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what,
                                              TriangleColumns& columns);
/// Shows every triangle of a side file in order, some at a time with their columns, without holding
/// the file. Does not check the file's checksum: that is up to the caller's `fill`.
void scan_boundary(
    const Fill& fill, std::string_view what,
    const std::function<void(std::span<const BoundaryTriangle>, const TriangleColumnsView&)>& show);

}  // namespace meshfarm
