// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_all_buffers_bytes = std::size_t{32} << 20;
constexpr std::size_t k_min_buffer_bytes = std::size_t{4} << 10;
constexpr std::size_t k_max_buffer_bytes = std::size_t{1} << 20;

}  // namespace

BucketFile::BucketFile(const std::filesystem::path& folder, std::size_t buckets)
    : folder_(folder),
      buffer_bytes_(std::clamp(k_all_buffers_bytes / std::max<std::size_t>(1, buckets),
                               k_min_buffer_bytes, k_max_buffer_bytes)),
      buckets_(buckets) {
  std::string name = (folder / "buckets.XXXXXX").string();
  fd_ = Fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!fd_) throw_errno("cannot make", name);
  ::unlink(name.c_str());
}

void BucketFile::append(std::size_t bucket, std::string_view bytes) {
  Bucket& b = buckets_[bucket];
  if (b.buffer.size() + bytes.size() > buffer_bytes_) flush(b);
  b.buffer.append(bytes);
}

void BucketFile::flush(Bucket& bucket) {
  if (bucket.buffer.empty()) return;
  write_all(fd_.get(), bucket.buffer, folder_ / "(scratch)");
  bucket.extents.push_back({end_, bucket.buffer.size()});
  end_ += bucket.buffer.size();
  bucket.buffer.clear();
}

void BucketFile::finish() {
  for (Bucket& bucket : buckets_) {
    flush(bucket);
    bucket.buffer.shrink_to_fit();
  }
}

std::uint64_t BucketFile::size(std::size_t bucket) const {
  std::uint64_t sum = buckets_[bucket].buffer.size();
  for (const Extent& extent : buckets_[bucket].extents) sum += extent.size;
  return sum;
}

void BucketFile::read_into(std::size_t bucket, char* to) const {
  for (const Extent& extent : buckets_[bucket].extents) {
    std::uint64_t done = 0;
    while (done < extent.size) {
      const ssize_t got = ::pread(fd_.get(), to + done, extent.size - done,
                                  static_cast<off_t>(extent.offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw_errno("cannot read", folder_ / "(scratch)");
      if (got == 0) throw IoError("scratch file cut short in", folder_, EIO);
      done += static_cast<std::uint64_t>(got);
    }
    to += extent.size;
  }
}

}  // namespace meshfarm
