// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// A count (u32), then the elements as in memory.
template <class T>
void put_list(ByteWriter& out, const std::vector<T>& values) {
  out.put(static_cast<std::uint32_t>(values.size()));
  out.put_array(std::span<const T>(values));
}

template <class T>
std::vector<T> get_list(ByteReader& in) {
  return in.get_array<T>(in.get<std::uint32_t>());
}

/// A file or section that consists of one list.
template <class T>
std::string encode_list(const std::vector<T>& values) {
  ByteWriter out;
  put_list(out, values);
  return out.take();
}

/// Throws an error naming `what` if the bytes are more or less than one list.
template <class T>
std::vector<T> decode_list(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  std::vector<T> values = get_list<T>(in);
  in.expect_end();
  return values;
}

}  // namespace meshfarm
