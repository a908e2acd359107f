// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Zstandard frames: the part of RFC 8878 (section 3.1) that is needed to find the end of one:
//   frame     = 0xFD2FB528 descriptor [window] [dictionary id] [content size] block* [checksum]
//   block     = 3 bytes: last (1 bit), type (2 bits), size (21 bits); then the content
//   skippable = 0x184D2A50..5F, a 4-byte size, then as many bytes
#include "byte_stream_zstd.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_zstd_magic = 0xFD2FB528;
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

/// Up to `count` bytes of the file at `offset`; fewer if it ends before.
std::string bytes_at(const InputFile& file, std::uint64_t offset, std::size_t count) {
  if (offset >= file.size()) return {};
  std::string bytes(std::min<std::uint64_t>(count, file.size() - offset), '\0');
  file.read(offset, bytes);
  return bytes;
}

/// The end of the data frame at `start`, from the headers of its blocks.
std::optional<std::uint64_t> end_of_data_frame(const InputFile& file, std::uint64_t start) {
  const std::string head = bytes_at(file, start, 5);
  if (head.size() < 5) return std::nullopt;
  const auto descriptor = static_cast<std::uint8_t>(head[4]);
  std::uint64_t offset = start + frame_header_bytes(descriptor);
  for (bool last = false; !last;) {
    const std::string bytes = bytes_at(file, offset, 3);
    if (bytes.size() < 3) return std::nullopt;
    const std::uint32_t block = load(bytes, 3);
    last = (block & 1) != 0;
    const bool one_byte_repeated = (block >> 1 & 3) == 1;
    offset += 3 + (one_byte_repeated ? 1 : block >> 3);
  }
  return offset + ((descriptor & 4) != 0 ? 4 : 0);
}

/// The end of the frame at `start`; nothing if the file ends before.
std::optional<std::uint64_t> end_of_frame(const InputFile& file, std::uint64_t start) {
  const std::string head = bytes_at(file, start, 8);
  const bool skippable = (load(head, 4) & ~0xFu) == k_skippable_magic;
  if (skippable && head.size() < 8) return std::nullopt;
  const std::optional<std::uint64_t> end =
      skippable ? start + 8 + load(head.substr(4), 4) : end_of_data_frame(file, start);
  return end && *end <= file.size() ? end : std::nullopt;
}

}  // namespace

bool is_zstd(std::string_view bytes) {
  if (bytes.size() < 4) return false;
  const std::uint32_t magic = load(bytes, 4);
  return magic == k_zstd_magic || (magic & ~0xFu) == k_skippable_magic;
}

void check_zstd_frames(const InputFile& file) {
  std::uint64_t offset = 0;
  while (is_zstd(bytes_at(file, offset, 4))) {
    const std::optional<std::uint64_t> end = end_of_frame(file, offset);
    if (!end) {
      throw DataError(file.path().string() +
                      ": the zstd data is truncated: the frame that starts at byte " +
                      std::to_string(offset) + " has no end");
    }
    offset = *end;
  }
  if (offset != file.size()) {
    throw DataError(file.path().string() + ": the zstd data is corrupt: no frame starts at byte " +
                    std::to_string(offset));
  }
}

}  // namespace meshfarm
