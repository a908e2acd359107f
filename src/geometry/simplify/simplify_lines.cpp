// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meshfarm {

namespace {

/// The cosine or sine of an angle up to 45 degrees, by its series, which begins with `term`, the
/// term of power `power`.
double series(double angle, double term, int power) {
  constexpr int k_most_terms = 12;
  double sum = 0;
  for (int i = 0; i < k_most_terms; ++i, power += 2) {
    sum += term;
    term *= -angle * angle / ((power + 1) * (power + 2));
  }
  return sum;
}

/// The cosine of an angle from 0 to 180 degrees; exactly 0 for 90. By plain arithmetic: std::cos
/// may differ between processors, and workers must agree on every bit.
double cosine_of(double degrees) {
  if (degrees > 90) return -cosine_of(180 - degrees);
  constexpr double k_degree = std::numbers::pi / 180;
  if (degrees <= 45) return series(degrees * k_degree, 1, 0);
  const double rest = (90 - degrees) * k_degree;
  return series(rest, rest, 1);
}

}  // namespace

double label_line_weight(std::uint64_t on_lines, std::uint64_t vertices) {
  constexpr double k_of_labels = 7;
  constexpr std::uint64_t k_percent_before = 50;
  constexpr std::uint64_t k_percent_to_halve = 2;
  const std::uint64_t percent = vertices == 0 ? 0 : 100 * on_lines / vertices;
  const std::uint64_t beyond = percent - std::min(percent, k_percent_before);
  return std::ldexp(k_of_labels, -static_cast<int>(beyond / k_percent_to_halve));
}

CreaseTest::CreaseTest(double degrees) {
  constexpr double k_below_all = -2;
  const double cosine = cosine_of(degrees);
  cosine_squared_ = degrees > 0 ? cosine * std::abs(cosine) : k_below_all;
}

void CreaseLines::find(const Mesh& mesh, const Adjacency& adjacency,
                       std::vector<std::uint8_t>& flags) {
  if (!exists_) return;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    // Both ends of an edge see it; one of them is enough.
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
                         std::vector<std::uint8_t>& flags) {
  if (!exists_) return;
  const std::vector<std::uint8_t> before = flags;
  std::uint64_t vertices = 0;
  std::uint64_t between_labels = 0;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    vertices += adjacency.count(v) > 0 ? 1 : 0;
    if ((before[v] & k_crease) == 0) continue;
    const Updated now = look_at(v, mesh.positions, adjacency, before);
    flags[v] = now.flags;
    between_labels += now.is_between_labels ? 1 : 0;
  }
  still_sharp_.weigh_labels(label_line_weight(between_labels, vertices));
}

std::uint8_t CreaseLines::updated(std::uint32_t vertex, std::span<const Vec3> positions,
                                  const Adjacency& adjacency,
                                  std::span<const std::uint8_t> flags) const {
  return look_at(vertex, positions, adjacency, flags).flags;
}

CreaseLines::Updated CreaseLines::look_at(std::uint32_t vertex, std::span<const Vec3> positions,
                                          const Adjacency& adjacency,
                                          std::span<const std::uint8_t> flags) const {
  const auto is_on_crease = [&](std::uint32_t end) { return (flags[end] & k_crease) != 0; };
  int creases = 0;
  Updated now{static_cast<std::uint8_t>(flags[vertex] & ~(k_crease | k_corner))};
  for_crease_edges(adjacency.fan_at(vertex), positions[vertex], positions, still_sharp_,
                   is_on_crease, [&](const Corner&, const Corner&, bool is_between_labels) {
                     ++creases;
                     now.is_between_labels = now.is_between_labels || is_between_labels;
                   });
  if (creases == 0) return now;
  now.flags |= k_crease;
  if (creases != 2 || (now.flags & k_border) != 0) now.flags |= k_corner;
  return now;
}

}  // namespace meshfarm
