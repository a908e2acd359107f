// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// Many growing byte strings in one scratch file, through buffers of bounded size: a full buffer
/// goes to the end of the file, and its bucket remembers where. The file has no name and is removed
/// when its owner ends. Full buffers stay in memory instead while `memory_bytes` allows it: writing
/// and reading them back would cost more than the work itself.
class BucketFile {
 public:
  /// Approximate size of all buffers of a file together.
  static constexpr std::uint64_t k_all_buffers_bytes = std::uint64_t{32} << 20;

  BucketFile(const std::filesystem::path& folder, std::size_t buckets,
             std::uint64_t memory_bytes = 0);
  void append(std::size_t bucket, std::string_view bytes);
  template <class T>
  void put(std::size_t bucket, const T& value) {
    append(bucket, {reinterpret_cast<const char*>(&value), sizeof(T)});
  }
  /// Writes out the remaining buffered data and frees the buffers; nothing may be appended
  /// afterwards. Throws IoError if not everything could be stored.
  void finish();
  /// The whole bucket, as values of T. Thread-safe after finish().
  template <class T>
  std::vector<T> read(std::size_t bucket) const {
    std::vector<T> values(size(bucket) / sizeof(T));
    read_into(bucket, 0, size(bucket), reinterpret_cast<char*>(values.data()));
    return values;
  }
  /// The value at this index of a bucket of values of T. As thread-safe as read(), and slow.
  template <class T>
  T read_one(std::size_t bucket, std::uint64_t index) const {
    T value;
    read_into(bucket, index * sizeof(T), sizeof(T), reinterpret_cast<char*>(&value));
    return value;
  }
  std::uint64_t size(std::size_t bucket) const;

 private:
  struct Extent {
    std::uint64_t offset = 0;  // in the memory; at or beyond its size: in the file
    std::uint64_t size = 0;
  };
  struct Bucket {
    std::string buffer;
    std::vector<Extent> extents;
  };
  void flush(Bucket& bucket);
  void store(Bucket& bucket, std::string_view bytes);
  void read_into(std::size_t bucket, std::uint64_t from, std::uint64_t size, char* to) const;
  void read_file_into(std::uint64_t offset, std::uint64_t size, char* to) const;

  std::filesystem::path folder_;
  Fd fd_;
  std::uint64_t end_ = 0;  // of the file
  std::size_t buffer_bytes_;
  MappedFile memory_;
  std::uint64_t kept_ = 0;  // bytes of memory in use
  std::vector<Bucket> buckets_;
};

}  // namespace meshfarm
