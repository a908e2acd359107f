// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/knee.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

/// Factor between consecutive counts. More than two such steps are not a little more.
constexpr double k_step = 1.25;
/// Reaches 86 times the goal.
constexpr int k_steps = 20;
/// With more triangles than this, keeping them would take too much memory.
constexpr std::uint64_t k_large = 1'000'000;
/// A knee is reported only if the error falls by more than this factor.
constexpr double k_least_gain = 3;
/// An error below this fraction of the diagonal is not visible.
constexpr double k_visible = 1e-4;
/// And one above this is obvious.
constexpr double k_plain = 1e-3;

/// Past a knee the error falls by more than the fifth power of the number of triangles: with 1.5
/// times as many, to an eighth. For scans it is a power of 1 to 1.5, for machined parts up to 4.5.
double least_gain(double times) {
  return std::max(k_least_gain, times * times * times * times * times);
}

}  // namespace

std::vector<std::uint64_t> counts_before_knee(std::uint64_t goal) {
  std::vector<std::uint64_t> counts;
  if (goal > k_large) return counts;
  auto count = static_cast<double>(goal);
  for (int step = 0; step < k_steps; ++step) {
    count *= k_step;
    counts.push_back(static_cast<std::uint64_t>(count));
  }
  std::reverse(counts.begin(), counts.end());
  return counts;
}

bool is_a_little_more(std::uint64_t goal, std::uint64_t triangles) {
  return static_cast<double>(triangles) <= k_step * k_step * static_cast<double>(goal);
}

bool is_visible(double rms_of_diagonal) {
  return rms_of_diagonal > k_visible;
}

bool is_plain(double rms_of_diagonal) {
  return rms_of_diagonal > k_plain;
}

bool is_past_knee(const CountAndError& made, const CountAndError& better) {
  if (made.triangles == 0 || better.triangles <= made.triangles) return false;
  const double times = static_cast<double>(better.triangles) / static_cast<double>(made.triangles);
  return made.rms > least_gain(times) * better.rms;
}

}  // namespace meshfarm
