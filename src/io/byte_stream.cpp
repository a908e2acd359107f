// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "byte_stream.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <meshfarm/util/errors.hpp>

#include "byte_stream_inflate.hpp"
#include "byte_stream_zstd.hpp"

namespace meshfarm {
namespace {

/// Slides over a plain file; holds one window in memory.
class PlainStream final : public ByteStream {
 public:
  explicit PlainStream(const InputFile& file)
      : file_(file), buffer_(std::make_unique_for_overwrite<char[]>(k_max_window_bytes)) {
    current_ = end_ = buffer_.get();
  }

  std::uint64_t position() const override {
    return read_ - static_cast<std::uint64_t>(end_ - current_);
  }
  std::optional<std::uint64_t> remaining() const override { return file_.size() - position(); }

 private:
  void widen(std::size_t at_least) override {
    const auto held = static_cast<std::size_t>(end_ - current_);
    std::memmove(buffer_.get(), current_, held);
    const std::size_t wanted = std::min(std::max(at_least, k_step_bytes), k_max_window_bytes);
    const auto more =
        std::min<std::uint64_t>(wanted - std::min(wanted, held), file_.size() - read_);
    file_.read(read_, {buffer_.get() + held, more});
    read_ += more;
    current_ = buffer_.get();
    end_ = current_ + held + more;
  }
  bool jump(std::uint64_t count) override {
    const std::uint64_t ahead = file_.size() - position();
    read_ = position() + std::min(count, ahead);
    current_ = end_ = buffer_.get();
    return count <= ahead;
  }

  static constexpr std::size_t k_step_bytes = std::size_t{256} << 10;  // stays in the near caches
  const InputFile& file_;
  std::unique_ptr<char[]> buffer_;
  std::uint64_t read_ = 0;  // the position in the file up to which it was read
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
  // Opening a pipe would wait for its writer, perhaps for ever, and it cannot be read twice.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw DataError(path_.string() + ": not a regular file; a mesh is read more than once");
  }
  fd_ = open_for_read(path_);
  size_ = file_size(fd_.get(), path_);
  std::array<char, 4> start{};
  const std::size_t count = std::min<std::uint64_t>(size_, start.size());
  read(0, std::span(start).first(count));
  compression_ = compression_of({start.data(), count});
  if (compression_ == Compression::zstd) check_zstd_frames(*this);
}

void InputFile::read(std::uint64_t offset, std::span<char> out) const {
  const std::size_t got = read_at(fd_.get(), offset, out, path_);
  if (got == out.size()) return;
  throw DataError(path_.string() + ": became shorter while it was read: of " +
                  std::to_string(size_) + " bytes it ends at byte " + std::to_string(offset + got));
}

std::unique_ptr<ByteStream> InputFile::open() const {
  if (compression_ == Compression::none) return std::make_unique<PlainStream>(*this);
  return open_compressed(*this);
}

bool has_extension(const InputFile& file, std::string_view extension) {
  const auto matches = [extension](const std::filesystem::path& path) {
    const std::string own = path.extension().string();
    return std::equal(own.begin(), own.end(), extension.begin(), extension.end(),
                      [](char a, char b) { return a == b || (a | 0x20) == b; });
  };
  return matches(file.path()) ||
         (file.compression() != Compression::none && matches(file.path().stem()));
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
