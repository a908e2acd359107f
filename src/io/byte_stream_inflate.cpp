// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "byte_stream_inflate.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

namespace bio = boost::iostreams;

constexpr std::streamsize k_filter_bytes = 1 << 16;

/// The compressed bytes. The filters would report a read error as one of their own, or ignore it,
/// so it is kept for the caller.
class FileDevice {
 public:
  using char_type = char;            // NOLINT(readability-identifier-naming): Boost's name
  using category = bio::source_tag;  // NOLINT(readability-identifier-naming): Boost's name

  FileDevice(const InputFile& file, std::exception_ptr& error) : file_(&file), error_(&error) {}

  std::streamsize read(char* out, std::streamsize wanted) {
    const auto count = std::min(static_cast<std::uint64_t>(wanted), file_->size() - offset_);
    if (count == 0 || *error_) return -1;
    try {
      file_->read(offset_, {out, count});
    } catch (...) {
      *error_ = std::current_exception();
      return -1;
    }
    offset_ += count;
    return static_cast<std::streamsize>(count);
  }

 private:
  const InputFile* file_;
  std::exception_ptr* error_;
  std::uint64_t offset_ = 0;
};

class InflatedStream final : public ByteStream {
 public:
  explicit InflatedStream(const InputFile& file)
      : path_(file.path()),
        compression_(file.compression()),
        buffer_(std::make_unique_for_overwrite<char[]>(k_max_window_bytes)) {
    if (compression_ == Compression::gzip) {
      input_.push(bio::gzip_decompressor(bio::gzip::default_window_bits, k_filter_bytes),
                  k_filter_bytes);
    } else {
      input_.push(bio::zstd_decompressor(k_filter_bytes), k_filter_bytes);
    }
    input_.push(FileDevice(file, read_error_), k_filter_bytes);
    current_ = end_ = buffer_.get();
  }

  std::uint64_t position() const override {
    return inflated_ - static_cast<std::uint64_t>(end_ - current_);
  }
  std::optional<std::uint64_t> remaining() const override { return std::nullopt; }

 private:
  void widen(std::size_t at_least) override {
    auto held = static_cast<std::size_t>(end_ - current_);
    std::memmove(buffer_.get(), current_, held);
    while (held < std::min(at_least, k_max_window_bytes) && !at_end_) {
      const std::size_t got = inflate(buffer_.get() + held, k_max_window_bytes - held);
      at_end_ = got == 0;
      held += got;
      inflated_ += got;
    }
    current_ = buffer_.get();
    end_ = current_ + held;
  }

  bool jump(std::uint64_t count) override {
    while (count > 0) {
      const std::size_t step = std::min<std::uint64_t>(count, window(1).size());
      if (step == 0) return false;
      consume(step);
      count -= step;
    }
    return true;
  }

  std::size_t inflate(char* out, std::size_t room) {
    try {
      const std::streamsize got = input_.sgetn(out, static_cast<std::streamsize>(room));
      if (!read_error_) return got > 0 ? static_cast<std::size_t>(got) : 0;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {  // the filters' messages mean nothing to a user
      if (read_error_) std::rethrow_exception(read_error_);
      throw DataError(path_.string() + ": the " + std::string(name_of(compression_)) +
                      " data is corrupt or truncated, somewhere after byte " +
                      std::to_string(inflated_) + " of what it holds");
    }
    std::rethrow_exception(read_error_);
  }

  std::filesystem::path path_;
  Compression compression_;
  std::unique_ptr<char[]> buffer_;
  std::exception_ptr read_error_;
  bio::filtering_streambuf<bio::input> input_;
  std::uint64_t inflated_ = 0;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<ByteStream> open_compressed(const InputFile& file) {
  return std::make_unique<InflatedStream>(file);
}

}  // namespace meshfarm
