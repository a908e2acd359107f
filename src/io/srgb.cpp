// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "srgb.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace meshfarm {
namespace {

constexpr double k_most = 255;
using Curve = std::array<double, 256>;

/// x^2.4 for x from 0.05 to 1, without std::pow, whose last bits differ between machines.
double to_the_2_4(double x) {
  // x^0.4 is the fifth root of x^2: Newton's method from above.
  const double square = x * x;
  double root = 1;
  for (int i = 0; i < 40; ++i) {
    const double fourth = root * root * root * root;
    root = (4 * root + square / fourth) / 5;
  }
  return square * root;
}

const Curve& linear_levels() {
  static const Curve levels = [] {
    Curve made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      const double level = static_cast<double>(i) / k_most;
      made[i] = level <= 0.04045 ? level / 12.92 : to_the_2_4((level + 0.055) / 1.055);
    }
    made.back() = 1;
    return made;
  }();
  return levels;
}

}  // namespace

double linear_of_srgb(double level) {
  if (!(level > 0)) return 0;
  if (level >= 1) return 1;
  const Curve& levels = linear_levels();
  const double place = level * k_most;
  const auto below = std::min(static_cast<std::size_t>(place), levels.size() - 2);
  const double share = place - static_cast<double>(below);
  return levels[below] + share * (levels[below + 1] - levels[below]);
}

double srgb_of_linear(double level) {
  if (!(level > 0)) return 0;
  if (level >= 1) return 1;
  const Curve& levels = linear_levels();
  const auto above = std::upper_bound(levels.begin(), levels.end(), level);
  const auto below = static_cast<std::size_t>(above - levels.begin()) - 1;
  const double share = (level - levels[below]) / (levels[below + 1] - levels[below]);
  return (static_cast<double>(below) + share) / k_most;
}

const std::array<float, 256>& linear_floats() {
  static const std::array<float, 256> levels = [] {
    std::array<float, 256> made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      made[i] = static_cast<float>(linear_of_srgb(static_cast<double>(i) / 255));
    }
    return made;
  }();
  return levels;
}

}  // namespace meshfarm
