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

/// The properties of a PNG or JPEG, from its header.
struct PictureFacts {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool is_lossy = false;
  std::uint64_t decoding_bytes = 0;  // the memory TiledPicturesWriter takes beside the file's bytes
};

/// Reads the header. Throws DataError for what is neither, malformed, or too large.
PictureFacts picture_facts(std::string_view file);

/// Pictures in tiles that can be read one by one, with their smaller copies.
struct TiledPicturesRef {
  FileRef file;
  FileSection directory;  // says where the tiles are
};

/// Writes pictures as tiles. One picture is in memory at a time.
class TiledPicturesWriter {
 public:
  explicit TiledPicturesWriter(const std::function<void(std::string_view)>& write)
      : sections_(write) {}
  /// Decodes a PNG or JPEG; `number` is its index among the mesh's pictures. Throws DataError for a
  /// damaged one, of which nothing is written.
  void add(std::uint32_t number, std::string file);
  /// To be called once, at the end: returns where the directory is.
  FileSection finish();

 private:
  SectionWriter sections_;
  ByteWriter directory_;
  std::uint32_t pictures_ = 0;
};

}  // namespace meshfarm
