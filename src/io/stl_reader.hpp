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

/// Shows the triangles of a soup, as in STL: triangle t has the vertices 3 t, 3 t + 1 and 3 t + 2.
/// Vertices at one point are merged only by welding.
void take_soup(std::uint64_t triangles, const std::function<void(const TriangleView&)>& take);

/// Whether the file is text with facets.
bool is_ascii_stl_file(const InputFile& file);
/// Throws DataError for text that is not STL.
std::unique_ptr<MeshSource> open_ascii_stl(InputFile file, const OpenOptions& options);

/// Whether the file's size fits its count of triangles; the name .stl is enough, too.
bool is_binary_stl_file(const InputFile& file);
/// The number of triangles comes from the size: 84 + 50 n bytes. Only if the size is of another
/// form, the count is used, and DataError thrown if the file is too short for it.
std::unique_ptr<MeshSource> open_binary_stl(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
