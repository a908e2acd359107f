// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Whether it names a file in this folder or below it.
bool is_beneath(const std::filesystem::path& path);

/// The file that a mesh's or a material's text names, in this folder or below it: its path as it
/// stands there, with either kind of slash, or else its name alone; in any case of letters if
/// there is none of its own. So files from other systems are found.
std::optional<std::filesystem::path> find_beside(const std::filesystem::path& folder,
                                                 std::string_view name);

/// All bytes of a regular file of at most 1 GiB. Throws IoError, or DataError.
std::string read_beside(const std::filesystem::path& path);

}  // namespace meshfarm
