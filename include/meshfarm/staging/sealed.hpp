// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshfarm {

/// Four characters that distinguish the kinds of staged files.
using FileKind = std::array<char, 4>;

inline constexpr std::size_t k_seal_head_bytes = 24;

/// Wraps a payload as a staged file: magic, kind, version, endianness, size, payload, checksum.
std::string seal(FileKind kind, std::uint32_t version, std::string_view payload);

/// The head before a payload of this size. The checksum of everything before it follows the
/// payload.
std::string seal_head(FileKind kind, std::uint32_t version, std::uint64_t payload_bytes);

/// The payload within `file`. Throws DataError naming `what` if the file is of another kind or
/// version, cut short, longer than it says, or damaged.
std::string_view unseal(std::string_view file, FileKind kind, std::uint32_t version,
                        std::string_view what);

/// The payload's size from a file's first k_seal_head_bytes, for files that are read in pieces.
/// Throws like unseal; damage to the file must be found by its reader.
std::uint64_t unseal_head(std::string_view head, FileKind kind, std::uint32_t version,
                          std::string_view what);

}  // namespace meshfarm
