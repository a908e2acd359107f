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

}  // namespace

NormalSamples::NormalSamples(const Manifest& manifest, double area)
    : parts_(manifest.parts.size() + 1) {
  const double points = k_points_a_triangle * static_cast<double>(manifest.triangles());
  per_area_ = area > 0 ? std::clamp(points, k_least_points, k_most_points) / area : 0;
}

void NormalSamples::add(const SurfacePiece& piece) {
  OfPart& part = parts_[piece.part];
  const auto whole_points = [&](double area) {
    part.due += per_area_ * area;
    const double count = std::floor(part.due);
    part.due -= count;
    return static_cast<std::uint64_t>(count);
  };
  const PieceSamples found = sample_piece(piece.positions, piece.triangles, whole_points, {});
  Points& to = part.sampled;
  to.points.insert(to.points.end(), found.points.begin(), found.points.end());
  // So that a piece too small for a point is represented by the next one.
  to.areas.insert(to.areas.end(), found.points.size(), 1 / per_area_);
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
