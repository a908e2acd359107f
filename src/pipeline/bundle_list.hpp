// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Encoding of bundles in parameters of jobs:
//   bundles  = position type u8 | parts u32 | vertices u32 x (file | directory section | runs
//              section | crowds section | merged u64 | of parts) | triangles u32 x (file |
//              directory section | seams section | seam triangles u64 | dropped u64 | points left
//              out u64 | vertices section | groups u32 | of parts)
//   of parts = told u8 | if told: u32 x (part u32, of vertices: | count u32)
// A summary has what follows the file. The list of parts is left out if it takes too much room:
// that of a bundle in a summary, those of all bundles in parameters.
#pragma once

#include <string>
#include <string_view>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

void put_bundles(ByteWriter& out, const BundlesOfMesh& bundles);
/// Throws DataError for bytes that put_bundles() did not write.
BundlesOfMesh get_bundles(ByteReader& in);

std::string encode_summary(const VertexBundle& bundle);
std::string encode_summary(const TriangleBundle& bundle);
VertexBundle decode_vertex_bundle(std::string_view summary, std::string_view what);
TriangleBundle decode_triangle_bundle(std::string_view summary, std::string_view what);

}  // namespace meshfarm
