// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_positions.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace meshfarm {
PlyPositions::PlyPositions(Read read, const Place& place)
    : read_(std::move(read)),
      place_(place),
      records_a_block_(std::max<std::uint64_t>(1, k_block_bytes / place.layout.record_bytes)),
      blocks_(k_blocks) {}

std::unique_ptr<PlyPositions> PlyPositions::in_file(const InputFile& file,
                                                    const PlyHeader& header) {
  if (header.format == PlyFormat::ascii || file.compression() != Compression::none) return nullptr;
  Place place{.layout = {}, .format = header.format, .start = header.size_bytes};
  for (const PlyElement& element : header.elements) {
    if (element.has_lists()) return nullptr;
    if (element.role == PlyRole::vertices) break;
    place.start += element.count * element.record_bytes(header.format);
  }
  place.layout = vertex_layout(header.vertices());
  place.count = header.vertices().count;
  const auto read = [&file](std::uint64_t offset, std::span<char> out) { file.read(offset, out); };
  return std::unique_ptr<PlyPositions>(new PlyPositions(read, place));
}

std::unique_ptr<PlyPositions> PlyPositions::in_scratch(const KeptPositions& kept) {
  const bool wide = kept.type() == PositionType::float64;
  const std::size_t size = wide ? sizeof(double) : sizeof(float);
  Place place{.layout = {.record_bytes = 3 * size}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.layout.offsets[axis] = axis * size;
    place.layout.types[axis] = wide ? PlyType::float64 : PlyType::float32;
  }
  if constexpr (std::endian::native == std::endian::big) place.format = PlyFormat::binary_big;
  place.count = kept.count();
  const auto read = [&kept](std::uint64_t offset, std::span<char> out) { kept.read(offset, out); };
  return std::unique_ptr<PlyPositions>(new PlyPositions(read, place));
}

Vec3 PlyPositions::at(std::uint64_t vertex) {
  const std::size_t record = place_.layout.record_bytes;
  const std::uint64_t number = vertex / records_a_block_;
  const std::uint64_t first = number * records_a_block_;
  Block& block = blocks_[number % k_blocks];
  if (block.number != number) {
    block.number = UINT64_MAX;  // in case the read fails
    block.bytes.resize(std::min(records_a_block_, place_.count - first) * record);
    read_(place_.start + first * record, block.bytes);
    block.number = number;
  }
  const char* bytes = block.bytes.data() + (vertex - first) * record;
  Vec3 position;
  if (place_.format == PlyFormat::binary_big) {
    decode_vertices<std::endian::big>(place_.layout, bytes, {&position, 1});
  } else {
    decode_vertices<std::endian::little>(place_.layout, bytes, {&position, 1});
  }
  return position;
}

}  // namespace meshfarm
