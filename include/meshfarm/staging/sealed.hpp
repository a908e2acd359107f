// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshfarm {

/// Four characters that tell one kind of staged file from another.
using FileKind = std::array<char, 4>;

inline constexpr std::size_t k_seal_head_bytes = 24;

/// Wraps a payload as a staged file: magic, kind, version, endianness, size, payload, checksum.
std::string seal(FileKind kind, std::uint32_t version, std::string_view payload);

/// What stands before a payload of so many bytes. After it stands the checksum of all before that.
std::string seal_head(FileKind kind, std::uint32_t version, std::uint64_t payload_bytes);

/// The payload within `file`. Throws DataError naming `what` if the file is of another kind or
/// version, cut short, longer than it says, or damaged.
std::string_view unseal(std::string_view file, FileKind kind, std::uint32_t version,
                        std::string_view what);

/// For a file that is read in pieces: the payload's size by its first k_seal_head_bytes. Throws as
/// unseal does; whether the file is damaged its reader must find out.
std::uint64_t unseal_head(std::string_view head, FileKind kind, std::uint32_t version,
                          std::string_view what);

}  // namespace meshfarm
