// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "ply_header.hpp"

namespace meshfarm {

/// Whether the bytes start like an OFF file of any kind.
bool is_off(std::string_view start);

/// The header of an OFF file in terms of a PLY header: both bodies are lines of numbers, as many as
/// promised. `start`: the first bytes of the file, or all of it. Throws DataError naming `path` and
/// the line; also for a binary OFF, and for one that does not have three dimensions.
PlyHeader parse_off_header(std::string_view start, const std::filesystem::path& path);

}  // namespace meshfarm
