// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/bytes.hpp>

#include "io/picture_levels.hpp"

namespace meshfarm {

inline constexpr std::uint32_t k_picture_tile = 128;  // texels per side

/// The recently used tiles of several pictures, in memory.
class TileCache {
 public:
  explicit TileCache(std::uint64_t bytes) : room_(bytes) {}
  using Tile = std::shared_ptr<const std::string>;
  /// The tile with this number, read if it is not cached.
  template <class Read>
  Tile tile(std::uint64_t number, const Read& read) {
    const std::lock_guard lock(mutex_);
    if (const auto found = tiles_.find(number); found != tiles_.end()) {
      order_.splice(order_.begin(), order_, found->second);
      return found->second->tile;
    }
    order_.push_front({number, std::make_shared<const std::string>(read())});
    tiles_[number] = order_.begin();
    used_ += order_.front().tile->size();
    while (used_ > room_ && order_.size() > 1) {
      used_ -= order_.back().tile->size();
      tiles_.erase(order_.back().number);
      order_.pop_back();
    }
    return order_.front().tile;
  }

 private:
  struct Entry {
    std::uint64_t number;
    Tile tile;
  };
  std::mutex mutex_;
  std::uint64_t room_;
  std::uint64_t used_ = 0;
  std::list<Entry> order_;  // most recently used first
  std::unordered_map<std::uint64_t, std::list<Entry>::iterator> tiles_;
};

/// A tiled picture in a stage, read tile by tile.
class TiledLevels final : public PictureLevels {
 public:
  /// Reads its entry of a directory from `in`.
  TiledLevels(std::shared_ptr<const SectionedFile> file, ByteReader& in,
              std::shared_ptr<TileCache> cache);
  /// Its index among the mesh's pictures.
  std::uint32_t number() const { return number_; }
  const std::vector<LevelSize>& sizes() const override { return sizes_; }
  std::array<Texel, 4> texels(std::size_t level, std::uint32_t x0, std::uint32_t y0,
                              std::uint32_t x1, std::uint32_t y1) const override;

 private:
  std::uint32_t tile_at(std::size_t level, std::uint32_t x, std::uint32_t y) const;
  TileCache::Tile tile(std::uint32_t index) const;
  Texel texel(const std::string& tile, std::size_t level, std::uint32_t x, std::uint32_t y) const;

  std::shared_ptr<const SectionedFile> file_;
  std::uint32_t number_ = 0;
  std::shared_ptr<TileCache> cache_;
  std::vector<LevelSize> sizes_;
  std::vector<std::uint32_t> first_tiles_;  // of each level
  std::vector<FileSection> tiles_;
};

/// All pictures of a directory. Throws DataError naming `what`.
std::vector<std::unique_ptr<TiledLevels>> decode_tiled_pictures(
    std::string_view directory, std::string_view what,
    const std::shared_ptr<const SectionedFile>& file, const std::shared_ptr<TileCache>& cache);

/// All pictures of a file. Throws DataError, UnreadIoError.
std::vector<std::unique_ptr<TiledLevels>> open_tiled_pictures(
    const Stage& stage, const TiledPicturesRef& pictures, const std::shared_ptr<TileCache>& cache);

}  // namespace meshfarm
