// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/surface_sampler.hpp>

#include "geometry/random_unit.hpp"

namespace meshfarm {
namespace {

double area_of(Vec3 a, Vec3 b, Vec3 c) {
  return length(cross(b - a, c - a)) / 2;
}

}  // namespace

/// Sample n lies in the n-th share of the area, at a random place within it.
double SurfaceSampler::next_place() const {
  const auto n = samples_.size();
  return (static_cast<double>(n) + random_unit(3 * n)) * share_;
}

void SurfaceSampler::add(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (least_ == 0) return;
  if (!(share_ > 0)) {
    double area = 0;
    for (const auto& [a, b, c] : triangles)
      area += area_of(positions[a], positions[b], positions[c]);
    share_ = area / static_cast<double>(least_);
    if (!(share_ > 0)) return;
  }
  for (const auto& [a, b, c] : triangles) {
    area_ += area_of(positions[a], positions[b], positions[c]);
    while (next_place() < area_) add_point(positions[a], positions[b], positions[c]);
  }
}

void SurfaceSampler::add_point(Vec3 a, Vec3 b, Vec3 c) {
  samples_.push_back({random_place(a, b, c, samples_.size())});
  if (samples_.size() == 2 * least_) thin();
}

void SurfaceSampler::thin() {
  ++thinned_;
  for (std::size_t i = 0; i < least_; ++i) {
    samples_[i] = samples_[2 * i + (random_unit(i + thinned_ * least_) < 0.5 ? 0 : 1)];
  }
  samples_.resize(least_);
  share_ *= 2;
}

SurfaceSamples SurfaceSampler::take() {
  SurfaceSamples taken{area_, {}};
  taken.points.reserve(samples_.size());
  for (const Sample& sample : samples_) taken.points.push_back(sample.point);
  return taken;
}

}  // namespace meshfarm
