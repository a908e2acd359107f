// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <span>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_min_buffer_bytes = std::size_t{4} << 10;
constexpr std::size_t k_max_buffer_bytes = std::size_t{1} << 20;

}  // namespace

BucketFile::BucketFile(const std::filesystem::path& folder, std::size_t buckets,
                       std::uint64_t memory_bytes)
    : folder_(folder),
      buffer_bytes_(std::clamp(
          static_cast<std::size_t>(k_all_buffers_bytes) / std::max<std::size_t>(1, buckets),
          k_min_buffer_bytes, k_max_buffer_bytes)),
      memory_(MappedFile::memory(memory_bytes)),
      buckets_(buckets) {
  std::string name = (folder / "buckets.XXXXXX").string();
  fd_ = Fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!fd_) throw_errno("cannot make", name);
  ::unlink(name.c_str());
}

void BucketFile::append(std::size_t bucket, std::string_view bytes) {
  Bucket& b = buckets_[bucket];
  if (b.buffer.size() + bytes.size() > buffer_bytes_) flush(b);
  if (bytes.size() > buffer_bytes_) return store(b, bytes);
  b.buffer.append(bytes);
}

void BucketFile::flush(Bucket& bucket) {
  store(bucket, bucket.buffer);
  bucket.buffer.clear();
}

void BucketFile::store(Bucket& bucket, std::string_view bytes) {
  if (bytes.empty()) return;
  const std::span<char> memory = memory_.as_span<char>();
  if (bytes.size() <= memory.size() - kept_) {
    std::memcpy(memory.data() + kept_, bytes.data(), bytes.size());
    bucket.extents.push_back({kept_, bytes.size()});
    kept_ += bytes.size();
  } else {
    write_all(fd_.get(), bytes, folder_ / "(scratch)");
    bucket.extents.push_back({memory.size() + end_, bytes.size()});
    end_ += bytes.size();
  }
}

void BucketFile::finish() {
  for (Bucket& bucket : buckets_) {
    flush(bucket);
    bucket.buffer.shrink_to_fit();
  }
  if (end_ > 0 && reports_late(fd_.get()) && ::fdatasync(fd_.get()) != 0) {
    throw_errno("cannot write a scratch file in", folder_);
  }
}

std::uint64_t BucketFile::size(std::size_t bucket) const {
  std::uint64_t sum = buckets_[bucket].buffer.size();
  for (const Extent& extent : buckets_[bucket].extents) sum += extent.size;
  return sum;
}

void BucketFile::read_into(std::size_t bucket, std::uint64_t from, std::uint64_t size,
                           char* to) const {
  const std::string_view memory = memory_.bytes();
  for (const Extent& extent : buckets_[bucket].extents) {
    if (size == 0) return;
    if (from >= extent.size) {
      from -= extent.size;
      continue;
    }
    const std::uint64_t some = std::min(size, extent.size - from);
    const std::uint64_t offset = extent.offset + from;
    if (extent.offset < memory.size()) {
      std::memcpy(to, memory.data() + offset, some);
    } else {
      read_file_into(offset - memory.size(), some, to);
    }
    to += some;
    size -= some;
    from = 0;
  }
  if (size > 0) throw Error("a scratch file has no such value");
}

void BucketFile::read_file_into(std::uint64_t offset, std::uint64_t size, char* to) const {
  for (std::uint64_t done = 0; done < size;) {
    const ssize_t got =
        ::pread(fd_.get(), to + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_errno("cannot read", folder_ / "(scratch)");
    if (got == 0) throw IoError("scratch file cut short in", folder_, EIO);
    done += static_cast<std::uint64_t>(got);
  }
}

}  // namespace meshfarm
