// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A sub-mesh of the cut, its boundary vertices first.
struct Part {
  Mesh mesh;
  std::uint32_t boundary_vertices = 0;
  PositionType positions = PositionType::float32;
};

/// The whole staged file. Positions must be exact in `part.positions`.
std::string encode_part(const Part& part);
/// Throws DataError naming `what` for anything that encode_part did not make.
Part decode_part(std::string_view file, std::string_view what);

}  // namespace meshfarm
