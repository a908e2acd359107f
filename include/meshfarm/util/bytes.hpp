// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace meshfarm {

static_assert(std::endian::native == std::endian::little,
              "staged files and messages are little endian and are written as they lie in memory");

/// Appends plain values, little endian, to a byte string.
class ByteWriter {
 public:
  /// Reserves memory for this many bytes.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T)); }
  /// A length (u32), then the characters.
  void put_string(std::string_view text);
  /// The elements as in memory, without a count.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put_array(std::span<const T> values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote. Every read is bounds-checked: a short or malformed buffer
/// throws DataError naming `what` and the offset. Never allocates more than the buffer holds.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string_view what) : bytes_(bytes), what_(what) {}

  template <class T>
  requires std::is_trivially_copyable_v<T> T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string get_string();
  template <class T>
  requires std::is_trivially_copyable_v<T> std::vector<T> get_array(std::uint64_t count) {
    if (count > remaining() / sizeof(T)) fail("an array runs past the end");
    std::vector<T> values(count);
    const std::string_view raw = take(count * sizeof(T));
    if (count > 0) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  std::string_view take(std::size_t count);
  std::size_t remaining() const { return bytes_.size() - offset_; }
  std::size_t offset() const { return offset_; }
  /// Throws DataError unless everything was read.
  void expect_end() const;
  [[noreturn]] void fail(std::string_view why) const;

 private:
  std::string_view bytes_;
  std::string what_;
  std::size_t offset_ = 0;
};

}  // namespace meshfarm
