// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// A count (u32), then the elements as they lie in memory.
template <class T>
void put_list(ByteWriter& out, const std::vector<T>& values) {
  out.put(static_cast<std::uint32_t>(values.size()));
  out.put_array(std::span<const T>(values));
}

template <class T>
std::vector<T> get_list(ByteReader& in) {
  return in.get_array<T>(in.get<std::uint32_t>());
}

}  // namespace meshfarm
