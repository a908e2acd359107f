// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/errors.hpp>

#include "divide/bundle_file.hpp"

namespace meshfarm {

BlockPlaces::BlockPlaces(const Stage& stage, std::span<const VertexBundleRef> bundles,
                         std::uint32_t parts)
    : stage_(stage),
      bundles_(bundles),
      parts_(parts),
      files_(bundles.size()),
      read_(bundles.size()),
      first_(bundles.size() * parts, 0),
      count_(parts, 0) {
  const auto add = [&](std::size_t block, std::uint32_t part, std::uint32_t more) {
    if (part >= parts) throw DataError(bundles[block].file.name + ": of other parts");
    if (more > 0xfffffffe - count_[part]) {
      throw DataError("a part would have 2^32 vertices or more; ask for more --parts");
    }
    count_[part] += more;
  };
  for (std::size_t block = 0; block < bundles.size(); ++block) {
    std::copy(count_.begin(), count_.end(),
              first_.begin() + static_cast<std::ptrdiff_t>(block * parts));
    if (const auto& told = bundles[block].bundle.parts) {
      for (const VertexBundle::OfPart& of : *told) add(block, of.part, of.count);
    } else {
      for (const BundleEntry& entry : directory(block)) add(block, entry.part, entry.count);
    }
  }
}

std::uint32_t BlockPlaces::count(std::size_t block, std::uint32_t part) const {
  const bool is_last = block + 1 == bundles_.size();
  return (is_last ? count_[part] : first(block + 1, part)) - first(block, part);
}

const SectionedFile& BlockPlaces::file(std::size_t block) {
  if (!files_[block]) files_[block].emplace(stage_, bundles_[block].file);
  return *files_[block];
}

const std::vector<BundleEntry>& BlockPlaces::directory(std::size_t block) {
  if (!read_[block]) {
    read_[block] = read_section<BundleEntry>(file(block), bundles_[block].bundle.directory);
  }
  return *read_[block];
}

std::vector<Vec3> BlockPlaces::positions(std::size_t block, std::uint32_t part, PositionType type) {
  const std::vector<BundleEntry>& entries = directory(block);
  const auto at = std::lower_bound(
      entries.begin(), entries.end(), part,
      [](const BundleEntry& entry, std::uint32_t wanted) { return entry.part < wanted; });
  std::vector<Vec3> positions;
  if (at != entries.end() && at->part == part) {
    if (type == PositionType::float64) {
      positions = read_section<Vec3>(file(block), at->section);
    } else {
      const auto floats = read_section<std::array<float, 3>>(file(block), at->section);
      positions.reserve(floats.size());
      for (const auto& p : floats) positions.push_back({p[0], p[1], p[2]});
    }
  }
  if (positions.size() != count(block, part)) {
    throw DataError(bundles_[block].file.name + ": has other vertices than it says");
  }
  return positions;
}

std::string encode_bundles(std::span<const VertexBundleRef> bundles) {
  ByteWriter out;
  for (const VertexBundleRef& each : bundles) {
    put_file(out, each.file);
    out.put(each.bundle.directory);
  }
  return out.take();
}

std::vector<VertexBundleRef> decode_bundles(std::string_view bytes) {
  ByteReader in(bytes, "a list of bundles");
  std::vector<VertexBundleRef> bundles;
  while (in.remaining() > 0) {
    VertexBundleRef& each = bundles.emplace_back();
    each.file = get_file(in);
    each.bundle.directory = in.get<FileSection>();
  }
  return bundles;
}

}  // namespace meshfarm
