// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "ply_header.hpp"

namespace meshfarm {

/// Whether the bytes start like an OFF file, of whatever kind.
bool is_off(std::string_view start);

/// What `start`, the first bytes of an OFF file or all of it, declares, in the words of a PLY
/// header: the bodies of both are lines of numbers, as many as promised. Throws DataError naming
/// `path` and the line; also for a binary OFF, and for one of other than three dimensions.
PlyHeader parse_off_header(std::string_view start, const std::filesystem::path& path);

}  // namespace meshfarm
