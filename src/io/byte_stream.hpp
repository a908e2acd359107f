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
  /// The largest window that may be asked for.
  static constexpr std::size_t k_max_window_bytes = std::size_t{1} << 20;

  virtual ~ByteStream() = default;

  /// What lies ahead: at least `at_least` bytes, fewer only if the input ends before.
  std::string_view window(std::size_t at_least) {
    if (static_cast<std::size_t>(end_ - current_) < at_least) widen(at_least);
    return {current_, static_cast<std::size_t>(end_ - current_)};
  }
  /// Steps over bytes that the window showed.
  void consume(std::size_t count) { current_ += count; }
  /// Steps over `count` bytes. False if the input ends before; then the position is its end.
  bool skip(std::uint64_t count) {
    if (count > static_cast<std::uint64_t>(end_ - current_)) return jump(count);
    current_ += count;
    return true;
  }
  /// Offset of the window's first byte.
  virtual std::uint64_t position() const = 0;
  /// How many bytes lie ahead, if that is known.
  virtual std::optional<std::uint64_t> remaining() const = 0;

 protected:
  /// window() for more than is in view; skip() over more than is in view.
  virtual void widen(std::size_t at_least) = 0;
  virtual bool jump(std::uint64_t count) = 0;

  const char* current_ = nullptr;
  const char* end_ = nullptr;
};

enum class Compression { none, gzip, zstd };

/// An input file, plain or compressed (told by its content), that can be read any number of times.
class InputFile {
 public:
  /// Throws IoError; DataError for what is no regular file or a torn zstd file.
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  Compression compression() const { return compression_; }
  std::uint64_t size() const { return size_; }
  /// The bytes as they lie in the file, which has as many. Throws IoError, and DataError if the
  /// file has become shorter.
  void read(std::uint64_t offset, std::span<char> out) const;
  /// The bytes as they are once decompressed; the file must outlive the stream. What decompression
  /// finds wrong is a DataError.
  std::unique_ptr<ByteStream> open() const;

 private:
  std::filesystem::path path_;
  Fd fd_;
  std::uint64_t size_ = 0;
  Compression compression_ = Compression::none;
};

/// Whether the name ends so, in any case of letters, or so and with what it is compressed by:
/// "mesh.stl", "mesh.STL.gz".
bool has_extension(const InputFile& file, std::string_view extension);

/// "none", "gzip", "zstd"
std::string_view name_of(Compression compression);

}  // namespace meshfarm
