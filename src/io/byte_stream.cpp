// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "byte_stream.hpp"

#include <algorithm>
#include <cerrno>

#include <meshfarm/util/errors.hpp>

#include "byte_stream_inflate.hpp"
#include "byte_stream_zstd.hpp"

namespace meshfarm {
namespace {

/// Slides over a mapped file. What is behind the window is let go of, so that a scan needs the
/// memory of one window whatever the file's size.
class MappedStream final : public ByteStream {
 public:
  explicit MappedStream(const MappedFile& file) : file_(file), bytes_(file.bytes()) {
    current_ = end_ = bytes_.data();
  }
  ~MappedStream() override { release_behind(); }

  std::uint64_t position() const override {
    return static_cast<std::uint64_t>(current_ - bytes_.data());
  }
  std::optional<std::uint64_t> remaining() const override { return bytes_.size() - position(); }

 private:
  void widen(std::size_t at_least) override {
    release_behind();
    const std::size_t ahead = bytes_.size() - position();
    end_ = current_ + std::min(std::max(at_least, k_step_bytes), ahead);
  }
  bool jump(std::uint64_t count) override {
    const std::uint64_t ahead = bytes_.size() - position();
    release_behind();
    current_ += std::min(count, ahead);
    end_ = current_;
    released_ = position() / k_page_bytes * k_page_bytes;
    return count <= ahead;
  }
  void release_behind() {
    file_.release(released_, position() - released_);
    released_ = position() / k_page_bytes * k_page_bytes;
  }

  static constexpr std::size_t k_step_bytes = std::size_t{4} << 20;
  static constexpr std::uint64_t k_page_bytes = 4096;
  const MappedFile& file_;
  std::string_view bytes_;
  std::uint64_t released_ = 0;
};

Compression compression_of(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return Compression::gzip;
  return is_zstd(bytes) ? Compression::zstd : Compression::none;
}

}  // namespace

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (std::filesystem::is_directory(status)) throw IoError("cannot read", path_, EISDIR);
  // To open a pipe would wait for its writer, perhaps for ever, and it cannot be read twice.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw DataError(path_.string() + ": not a regular file; a mesh is read more than once");
  }
  file_ = MappedFile::open(path_);
  compression_ = compression_of(file_.bytes());
  if (compression_ == Compression::none) file_.advise_sequential();
  if (compression_ == Compression::zstd) check_zstd_frames(file_.bytes(), path_);
}

std::unique_ptr<ByteStream> InputFile::open() const {
  if (compression_ == Compression::none) return std::make_unique<MappedStream>(file_);
  return open_compressed(file_, compression_, path_);
}

std::string_view name_of(Compression compression) {
  switch (compression) {
    case Compression::none:
      return "none";
    case Compression::gzip:
      return "gzip";
    case Compression::zstd:
      return "zstd";
  }
  return "";
}

}  // namespace meshfarm
