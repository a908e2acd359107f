// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/normal_samples.hpp"

#include <algorithm>
#include <cmath>

namespace meshfarm {
namespace {

constexpr double k_least_points = 2'000;
constexpr double k_most_points = 20'000;
constexpr double k_points_a_triangle = 0.005;
constexpr std::uint64_t k_most_sampled = 250'000;

std::vector<Triangle> every(std::uint64_t step, std::span<const Triangle> triangles) {
  std::vector<Triangle> some;
  some.reserve(triangles.size() / step + 1);
  for (std::size_t i = 0; i < triangles.size(); i += step) some.push_back(triangles[i]);
  return some;
}

}  // namespace

NormalSamples::NormalSamples(const Manifest& manifest)
    : step_((manifest.triangles() + k_most_sampled - 1) / k_most_sampled),
      parts_(manifest.parts.size() + 1) {
  const auto triangles = static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()));
  const double points = k_points_a_triangle * triangles;
  per_triangle_ = std::clamp(points, k_least_points, k_most_points) / triangles;
}

void NormalSamples::add(const SurfacePiece& piece) {
  OfPart& part = parts_[piece.part];
  const auto size = static_cast<double>(piece.triangles.size());
  part.due += per_triangle_ * size;
  const double count = std::floor(part.due);
  if (!(count > 0)) return;
  part.due -= count;
  const std::vector<Triangle> some = every(step_, piece.triangles);
  const PieceSamples found =
      sample_piece(piece.positions, some, static_cast<std::uint64_t>(count), {});
  if (found.points.empty()) return;
  // So that a piece that was passed over for its size counts by the next.
  const double each = found.area / static_cast<double>(some.size()) / per_triangle_;
  Points& to = part.sampled;
  to.points.insert(to.points.end(), found.points.begin(), found.points.end());
  to.areas.insert(to.areas.end(), found.points.size(), each);
}

NormalSamples::Points NormalSamples::take() {
  Points all;
  for (OfPart& part : parts_) {
    const Points& of = part.sampled;
    all.points.insert(all.points.end(), of.points.begin(), of.points.end());
    all.areas.insert(all.areas.end(), of.areas.begin(), of.areas.end());
    part = {};
  }
  return all;
}

}  // namespace meshfarm
