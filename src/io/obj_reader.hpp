// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"

namespace meshfarm {

/// Whether the first line that is no comment is an OBJ statement; for a file named .obj, being text
/// is enough.
bool is_obj_file(const InputFile& file);

/// Reads vertices and faces; other statements are counted by kind. Throws DataError for lines that
/// are no statements.
std::unique_ptr<MeshSource> open_obj(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
