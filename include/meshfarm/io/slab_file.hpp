// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <meshfarm/io/mesh_shares.hpp>

namespace meshfarm {

/// A share of a mesh as a staged file. Vertices and triangles keep the order they came in, which
/// decides between coincident vertices that are not welded. Positions must be exact in
/// `slab.type`; boundary vertices must be in ascending order, each once.
std::string encode_slab(const MeshShare& slab);
/// Throws DataError naming `what` for anything that encode_slab did not make.
MeshShare decode_slab(std::string_view file, std::string_view what);

}  // namespace meshfarm
