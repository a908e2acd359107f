// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"

namespace meshfarm {

/// The triangles of a soup, as STL is one: triangle t has the vertices 3 t, 3 t + 1 and 3 t + 2.
/// Vertices at one point are joined by a weld only.
void take_soup(std::uint64_t triangles, const std::function<void(const TriangleView&)>& take);

/// Whether the file is text with facets.
bool is_ascii_stl_file(const InputFile& file);
/// Throws DataError for text that is no STL.
std::unique_ptr<MeshSource> open_ascii_stl(InputFile file, const OpenOptions& options);

/// Whether the file is as long as the triangles that it counts; of a file named .stl that its
/// length is that of so many triangles, or more, is enough.
bool is_binary_stl_file(const InputFile& file);
/// The size tells how many triangles there are: 84 + 50 n bytes. Only of a file with another size
/// the count in it is taken, and DataError thrown if it cannot hold as many.
std::unique_ptr<MeshSource> open_binary_stl(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
