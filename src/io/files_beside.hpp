// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
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

/// The most bytes of a picture beside a mesh.
inline constexpr std::uint64_t k_most_picture_file = std::uint64_t{1} << 30;

/// All bytes of a regular file of no more than `most_bytes`. Throws IoError, or DataError.
std::string read_beside(const std::filesystem::path& path,
                        std::uint64_t most_bytes = k_most_picture_file);

}  // namespace meshfarm
