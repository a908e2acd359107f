// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Zstandard frames, as far as RFC 8878 (section 3.1) is needed to find where one ends:
//   frame     = 0xFD2FB528 descriptor [window] [dictionary id] [content size] block* [checksum]
//   block     = 3 bytes: last (1 bit), type (2 bits), size (21 bits); then the content
//   skippable = 0x184D2A50..5F, a 4-byte size, then as many bytes
#include "byte_stream_zstd.hpp"

#include <cstdint>
#include <optional>
#include <string>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_magic = 0xFD2FB528;
constexpr std::uint32_t k_skippable_magic = 0x184D2A50;

std::uint32_t load(std::string_view bytes, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
  }
  return value;
}

std::size_t frame_header_bytes(std::uint8_t descriptor) {
  constexpr std::size_t k_dictionary_bytes[] = {0, 1, 2, 4};
  constexpr std::size_t k_content_size_bytes[] = {0, 2, 4, 8};
  const bool single_segment = (descriptor & 0x20) != 0;
  std::size_t size = 5 + k_dictionary_bytes[descriptor & 3] + (single_segment ? 0 : 1);
  const unsigned content_flag = descriptor >> 6;
  size += content_flag == 0 && single_segment ? 1 : k_content_size_bytes[content_flag];
  return size;
}

std::optional<std::size_t> data_frame_bytes(std::string_view bytes) {
  if (bytes.size() < 5) return std::nullopt;
  const auto descriptor = static_cast<std::uint8_t>(bytes[4]);
  std::size_t offset = frame_header_bytes(descriptor);
  for (bool last = false; !last;) {
    if (offset > bytes.size() || bytes.size() - offset < 3) return std::nullopt;
    const std::uint32_t block = load(bytes.substr(offset), 3);
    last = (block & 1) != 0;
    const bool one_byte_repeated = (block >> 1 & 3) == 1;
    offset += 3 + (one_byte_repeated ? 1 : block >> 3);
  }
  return offset + ((descriptor & 4) != 0 ? 4 : 0);
}

/// Size of the frame that the bytes start with; nothing if they end before it does.
std::optional<std::size_t> frame_bytes(std::string_view bytes) {
  const bool skippable = (load(bytes, 4) & ~0xFu) == k_skippable_magic;
  if (skippable && bytes.size() < 8) return std::nullopt;
  const std::optional<std::size_t> size =
      skippable ? std::size_t{8} + load(bytes.substr(4), 4) : data_frame_bytes(bytes);
  return size && *size <= bytes.size() ? size : std::nullopt;
}

}  // namespace

bool is_zstd(std::string_view bytes) {
  if (bytes.size() < 4) return false;
  const std::uint32_t magic = load(bytes, 4);
  return magic == k_magic || (magic & ~0xFu) == k_skippable_magic;
}

void check_zstd_frames(std::string_view bytes, const std::filesystem::path& path) {
  std::size_t offset = 0;
  while (is_zstd(bytes.substr(offset))) {
    const std::optional<std::size_t> size = frame_bytes(bytes.substr(offset));
    if (!size) {
      throw DataError(path.string() +
                      ": the zstd data is truncated: the frame that starts at byte " +
                      std::to_string(offset) + " has no end");
    }
    offset += *size;
  }
  if (offset != bytes.size()) {
    throw DataError(path.string() + ": the zstd data is corrupt: no frame starts at byte " +
                    std::to_string(offset));
  }
}

}  // namespace meshfarm
