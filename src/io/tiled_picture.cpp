// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A file of tiled pictures consists of sections. A tile has 128 x 128 texels, or fewer at the right
// and lower sides:
//   texels x 3 x u8, row by row from the top
// The tiles are stored row by row from the top, those of the picture first, then those of its
// smaller copies. The last section is the directory, kind "TILE", version 1; the payload of a
// sealed file:
//   pictures u32 x (number u32 | width u32 | height u32 | tiles x (offset u64 | size u64 |
//   hash u64))
#include <algorithm>
#include <utility>

#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/picture.hpp"
#include "io/tiled_levels.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_tiles_kind = {'T', 'I', 'L', 'E'};
constexpr std::uint32_t k_tiles_version = 1;

std::uint32_t tiles_along(std::uint32_t texels) {
  return (texels + k_picture_tile - 1) / k_picture_tile;
}

/// The side of the tile that begins at `from`.
std::uint32_t tile_side(std::uint32_t from, std::uint32_t texels) {
  return std::min(k_picture_tile, texels - from);
}

}  // namespace

PictureFacts picture_facts(std::string_view file) {
  const PictureHead head = read_picture_head(file);
  // The picture and its copies, at four bytes per texel, beside the decoded picture.
  const std::uint64_t levels = std::uint64_t{4} * head.width * head.height;
  return {head.width, head.height, head.kind == PictureHead::Kind::jpeg,
          head.memory_bytes() + levels};
}

void TiledPicturesWriter::add(std::uint32_t number, std::string file) {
  const DecodedLevels levels(decode_picture(std::move(file)));
  ++pictures_;
  directory_.put(number);
  directory_.put(levels.sizes()[0].width);
  directory_.put(levels.sizes()[0].height);
  std::string tile;
  for (std::size_t level = 0; level < levels.sizes().size(); ++level) {
    const LevelSize size = levels.sizes()[level];
    for (std::uint32_t y0 = 0; y0 < size.height; y0 += k_picture_tile) {
      for (std::uint32_t x0 = 0; x0 < size.width; x0 += k_picture_tile) {
        tile.clear();
        const std::size_t row_bytes = 3 * std::size_t{tile_side(x0, size.width)};
        for (std::uint32_t y = y0; y < y0 + tile_side(y0, size.height); ++y) {
          tile.append(reinterpret_cast<const char*>(levels.at(level, x0, y)), row_bytes);
        }
        directory_.put(sections_.add(tile));
      }
    }
  }
}

FileSection TiledPicturesWriter::finish() {
  ByteWriter out;
  out.put(pictures_);
  out.put_array(std::span<const char>(directory_.bytes()));
  return sections_.add(seal(k_tiles_kind, k_tiles_version, out.bytes()));
}

std::vector<std::unique_ptr<TiledLevels>> decode_tiled_pictures(
    std::string_view directory, std::string_view what,
    const std::shared_ptr<const SectionedFile>& file, const std::shared_ptr<TileCache>& cache) {
  ByteReader in(unseal(directory, k_tiles_kind, k_tiles_version, what), what);
  std::vector<std::unique_ptr<TiledLevels>> opened;
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    opened.push_back(std::make_unique<TiledLevels>(file, in, cache));
  }
  in.expect_end();
  return opened;
}

std::vector<std::unique_ptr<TiledLevels>> open_tiled_pictures(
    const Stage& stage, const TiledPicturesRef& pictures, const std::shared_ptr<TileCache>& cache) {
  const auto file = std::make_shared<const SectionedFile>(stage, pictures.file);
  return decode_tiled_pictures(file->read(pictures.directory), pictures.file.name, file, cache);
}

TiledLevels::TiledLevels(std::shared_ptr<const SectionedFile> file, ByteReader& in,
                         std::shared_ptr<TileCache> cache)
    : file_(std::move(file)), cache_(std::move(cache)) {
  number_ = in.get<std::uint32_t>();
  const auto width = in.get<std::uint32_t>();
  const auto height = in.get<std::uint32_t>();
  if (std::min(width, height) == 0 || std::max(width, height) > k_most_picture_side) {
    in.fail("a picture of an impossible size");
  }
  sizes_ = level_sizes(width, height);
  std::uint32_t tiles = 0;
  for (const LevelSize& size : sizes_) {
    first_tiles_.push_back(tiles);
    tiles += tiles_along(size.width) * tiles_along(size.height);
  }
  tiles_ = in.get_array<FileSection>(tiles);
}

std::uint32_t TiledLevels::tile_at(std::size_t level, std::uint32_t x, std::uint32_t y) const {
  return first_tiles_[level] + y / k_picture_tile * tiles_along(sizes_[level].width) +
         x / k_picture_tile;
}

TileCache::Tile TiledLevels::tile(std::uint32_t index) const {
  const std::uint64_t number = std::uint64_t{number_} << 32U | index;
  return cache_->tile(number, [&] { return file_->read(tiles_[index]); });
}

PictureLevels::Texel TiledLevels::texel(const std::string& tile, std::size_t level, std::uint32_t x,
                                        std::uint32_t y) const {
  const std::uint32_t left = x - x % k_picture_tile;
  const std::size_t row = y % k_picture_tile;
  const std::size_t at = 3 * (row * tile_side(left, sizes_[level].width) + (x - left));
  if (at + 3 > tile.size()) throw DataError("a tile of a picture is too short");
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(tile[at + i]); };
  return {byte(0), byte(1), byte(2)};
}

std::array<PictureLevels::Texel, 4> TiledLevels::texels(std::size_t level, std::uint32_t x0,
                                                        std::uint32_t y0, std::uint32_t x1,
                                                        std::uint32_t y1) const {
  const std::array<std::array<std::uint32_t, 2>, 4> places = {
      {{x0, y0}, {x1, y0}, {x0, y1}, {x1, y1}}};
  std::array<Texel, 4> found{};
  TileCache::Tile last;
  std::uint32_t last_index = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [x, y] = places[i];
    const std::uint32_t index = tile_at(level, x, y);
    if (!last || index != last_index) last = tile(index);
    last_index = index;
    found[i] = texel(*last, level, x, y);
  }
  return found;
}

}  // namespace meshfarm
