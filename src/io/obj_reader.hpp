// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"

namespace meshfarm {

/// Whether the first line of the file that is no comment is a statement of OBJ; of a file named
/// .obj that it is text is enough.
bool is_obj_file(const InputFile& file);

/// Reads vertices and faces; what else there is is counted by what it is. Throws DataError for
/// lines that are no statements.
std::unique_ptr<MeshSource> open_obj(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
