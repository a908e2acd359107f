// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// The mesh's triangles in the order of a space-filling curve (Morton 1966), so that consecutive
/// triangles are near each other.
std::vector<std::uint32_t> along_a_curve(const Mesh& mesh);

}  // namespace meshfarm
