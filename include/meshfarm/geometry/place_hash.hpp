// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// A position by its bits. Adding 0.0 turns -0.0 into 0.0 and leaves all else.
struct PlaceKey {
  explicit PlaceKey(Vec3 p)
      : x(std::bit_cast<std::uint64_t>(p.x + 0.0)),
        y(std::bit_cast<std::uint64_t>(p.y + 0.0)),
        z(std::bit_cast<std::uint64_t>(p.z + 0.0)) {}
  friend bool operator==(const PlaceKey&, const PlaceKey&) = default;
  std::uint64_t x, y, z;
};

/// Its high bits are the better ones. Coordinates from a grid differ in few bits, all of them high:
/// each is mixed before the next.
inline std::uint64_t hash_of(const PlaceKey& key) {
  const auto mixed = [](std::uint64_t h) {
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93U;
    return h ^ (h >> 32);
  };
  return mixed(mixed(mixed(key.x) + key.y) + key.z) * 0x9e3779b97f4a7c15U;
}

}  // namespace meshfarm
