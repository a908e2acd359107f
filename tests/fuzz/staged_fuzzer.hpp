// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm::fuzz {

/// Gives a decoder the bytes as a file, and then sealed as the payload of a file of its kind, so
/// that they get past the checksum: once in each version, of which it takes its own. Only DataError
/// may be thrown.
template <class Decode>
void decode_staged(const std::uint8_t* data, std::size_t size, FileKind kind, Decode decode) {
  constexpr std::uint32_t k_most_versions = 9;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    decode(bytes);
  } catch (const DataError&) {
  }
  for (std::uint32_t version = 1; version <= k_most_versions; ++version) {
    try {
      decode(seal(kind, version, bytes));
    } catch (const DataError&) {
    }
  }
}

}  // namespace meshfarm::fuzz
