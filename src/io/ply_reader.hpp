// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"

namespace meshfarm {

/// Whether the file starts like a PLY file.
bool is_ply_file(const InputFile& file);

/// Whether the file starts like an OFF file.
bool is_off_file(const InputFile& file);

/// These read the header. They throw DataError if it is malformed, or claims more than the file can
/// hold.
std::unique_ptr<MeshSource> open_ply(InputFile file, const OpenOptions& options);
std::unique_ptr<MeshSource> open_off(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
