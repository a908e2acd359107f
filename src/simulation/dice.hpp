// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace meshfarm {

/// Splitmix64 (Steele, Lea, Flood 2014): cheap to start for each of ten thousand seeds, and unlike
/// the standard library's distributions the same with every library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  /// 0 .. below - 1; 0 if `below` is 0.
  std::uint64_t pick(std::uint64_t below) { return below == 0 ? 0 : next() % below; }
  /// [0, 1)
  double fraction() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  bool chance(double p) { return p > 0 && fraction() < p; }

 private:
  std::uint64_t state_;
};

}  // namespace meshfarm
