// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_lines.hpp"

#include <cmath>
#include <numbers>

namespace meshfarm {

namespace {

/// The cosine of up to 45 degrees, or the sine: its series, which begins with `term`, the term of
/// the power `power`.
double series(double angle, double term, int power) {
  constexpr int k_most_terms = 12;
  double sum = 0;
  for (int i = 0; i < k_most_terms; ++i, power += 2) {
    sum += term;
    term *= -angle * angle / ((power + 1) * (power + 2));
  }
  return sum;
}

/// Of an angle from 0 to 180 degrees, and exactly 0 of 90. By plain arithmetic: std::cos takes
/// other ways on other processors, and workers must agree on every bit.
double cosine_of(double degrees) {
  if (degrees > 90) return -cosine_of(180 - degrees);
  constexpr double k_degree = std::numbers::pi / 180;
  if (degrees <= 45) return series(degrees * k_degree, 1, 0);
  const double rest = (90 - degrees) * k_degree;
  return series(rest, rest, 1);
}

}  // namespace

CreaseTest::CreaseTest(double degrees) {
  constexpr double k_below_all = -2;
  const double cosine = cosine_of(degrees);
  cosine_squared_ = degrees > 0 ? cosine * std::abs(cosine) : k_below_all;
}

void CreaseLines::find(const Mesh& mesh, const Adjacency& adjacency,
                       std::vector<std::uint8_t>& flags) const {
  if (!exists_) return;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    // Of an edge between two vertices each end sees it; one of them is enough.
    const auto is_greater = [v](std::uint32_t end) { return end > v; };
    for_crease_edges(adjacency.fan_at(v), mesh.positions[v], mesh.positions, sharp_, is_greater,
                     [&](const Corner& one, const Corner&, bool) {
                       flags[v] |= k_crease;
                       flags[one.prev] |= k_crease;
                     });
  }
  update(mesh, adjacency, flags);
}

void CreaseLines::update(const Mesh& mesh, const Adjacency& adjacency,
                         std::vector<std::uint8_t>& flags) const {
  if (!exists_) return;
  const std::vector<std::uint8_t> before = flags;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    if ((before[v] & k_crease) != 0) flags[v] = updated(v, mesh.positions, adjacency, before);
  }
}

std::uint8_t CreaseLines::updated(std::uint32_t vertex, std::span<const Vec3> positions,
                                  const Adjacency& adjacency,
                                  std::span<const std::uint8_t> flags) const {
  const auto is_on_crease = [&](std::uint32_t end) { return (flags[end] & k_crease) != 0; };
  int creases = 0;
  for_crease_edges(adjacency.fan_at(vertex), positions[vertex], positions, still_sharp_,
                   is_on_crease, [&](const Corner&, const Corner&, bool) { ++creases; });
  auto now = static_cast<std::uint8_t>(flags[vertex] & ~(k_crease | k_corner));
  if (creases == 0) return now;
  now |= k_crease;
  if (creases != 2 || (now & k_border) != 0) now |= k_corner;
  return now;
}

}  // namespace meshfarm
