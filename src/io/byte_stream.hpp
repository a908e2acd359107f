// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// Bytes that are read once, front to back, through a window that slides over them.
class ByteStream {
 public:
  /// The largest window that may be requested.
  static constexpr std::size_t k_max_window_bytes = std::size_t{1} << 20;

  virtual ~ByteStream() = default;

  /// The bytes ahead: at least `at_least`, fewer only if the input ends before.
  std::string_view window(std::size_t at_least) {
    if (static_cast<std::size_t>(end_ - current_) < at_least) widen(at_least);
    return {current_, static_cast<std::size_t>(end_ - current_)};
  }
  /// Skips bytes of the window.
  void consume(std::size_t count) { current_ += count; }
  /// Skips `count` bytes. False if the input ends before; then the position is its end.
  bool skip(std::uint64_t count) {
    if (count > static_cast<std::uint64_t>(end_ - current_)) return jump(count);
    current_ += count;
    return true;
  }
  /// Offset of the window's first byte.
  virtual std::uint64_t position() const = 0;
  /// How many bytes are left, if known.
  virtual std::optional<std::uint64_t> remaining() const = 0;

 protected:
  /// window() and skip() for more bytes than the window holds.
  virtual void widen(std::size_t at_least) = 0;
  virtual bool jump(std::uint64_t count) = 0;

  const char* current_ = nullptr;
  const char* end_ = nullptr;
};

enum class Compression { none, gzip, zstd };

/// An input file, plain or compressed (detected by content), that can be read any number of times.
class InputFile {
 public:
  /// Throws IoError; DataError for anything but a regular file, or for a truncated zstd file.
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  Compression compression() const { return compression_; }
  std::uint64_t size() const { return size_; }
  /// The bytes as stored in the file, all of which must exist. Throws IoError, and DataError if the
  /// file has become shorter.
  void read(std::uint64_t offset, std::span<char> out) const;
  /// The decompressed bytes; the file must outlive the stream. Errors in the compressed data are a
  /// DataError.
  std::unique_ptr<ByteStream> open() const;

 private:
  std::filesystem::path path_;
  Fd fd_;
  std::uint64_t size_ = 0;
  Compression compression_ = Compression::none;
};

/// Whether the name has this extension, in any case of letters, with or without that of the
/// compression: "mesh.stl", "mesh.STL.gz".
bool has_extension(const InputFile& file, std::string_view extension);

/// "none", "gzip", "zstd"
std::string_view name_of(Compression compression);

}  // namespace meshfarm
