// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// What a PNG or JPEG says of itself.
struct PictureFacts {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool is_lossy = false;
  std::uint64_t decoding_bytes = 0;  // what TiledPicturesWriter takes beside the file's bytes
};

/// By its head. Throws DataError for what is neither, malformed, or too large.
PictureFacts picture_facts(std::string_view file);

/// Pictures in tiles that can be read one by one, with their smaller copies.
struct TiledPicturesRef {
  FileRef file;
  FileSection directory;  // tells where the tiles are
};

/// Writes pictures as tiles. One picture is in memory at a time.
class TiledPicturesWriter {
 public:
  explicit TiledPicturesWriter(const std::function<void(std::string_view)>& write)
      : sections_(write) {}
  /// Decodes a PNG or JPEG, of that number among the mesh's pictures. Throws DataError for one that
  /// is damaged; nothing of it is written then.
  void add(std::uint32_t number, std::string file);
  /// To be called once, after all: returns where the directory is.
  FileSection finish();

 private:
  SectionWriter sections_;
  ByteWriter directory_;
  std::uint32_t pictures_ = 0;
};

}  // namespace meshfarm
