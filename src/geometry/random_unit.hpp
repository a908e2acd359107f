// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// The n-th number of a fixed random sequence, in [0, 1): splitmix64 (Steele et al. 2014).
inline double random_unit(std::uint64_t n) {
  std::uint64_t z = (n + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53;
}

/// The corners' shares at the n-th random place of a triangle: uses numbers 3n + 1 and 3n + 2 of
/// the sequence.
inline std::array<double, 3> random_shares(std::uint64_t n) {
  const double root = std::sqrt(random_unit(3 * n + 1)), across = random_unit(3 * n + 2);
  return {1 - root, root * (1 - across), root * across};
}

/// The place with these shares.
inline Vec3 random_place(Vec3 a, Vec3 b, Vec3 c, std::uint64_t n) {
  const auto [of_a, of_b, of_c] = random_shares(n);
  return a * of_a + b * of_b + c * of_c;
}

}  // namespace meshfarm
