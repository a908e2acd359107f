// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Whether the path names a file in this folder or below it.
bool is_beneath(const std::filesystem::path& path);

/// The file, in this folder or below it, that a mesh's or a material's text names: first by the
/// path as written, with either kind of slash, then by ever fewer of its last parts; if there is no
/// exact match, in any case of letters. So files from other systems and folders are found.
std::optional<std::filesystem::path> find_beside(const std::filesystem::path& folder,
                                                 std::string_view name);

/// The maximum size of a picture beside a mesh, in bytes.
inline constexpr std::uint64_t k_most_picture_file = std::uint64_t{1} << 30;

/// All bytes of a regular file of at most `most_bytes`. Throws IoError, or DataError.
std::string read_beside(const std::filesystem::path& path,
                        std::uint64_t most_bytes = k_most_picture_file);

}  // namespace meshfarm
