// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/area_sampler.hpp"
#include "geometry/bvh.hpp"
#include "geometry/distance_sums.hpp"

namespace meshfarm {
namespace {

/// Measures one chunk of `count` samples.
DistanceSums measure_chunk(const Bvh& bvh, std::uint64_t count, std::uint64_t chunk,
                           AreaSampler sampler) {
  const std::uint64_t end = std::min(count, (chunk + 1) * k_samples_a_chunk);
  DistanceSums sums;
  std::uint32_t guess = 0;
  for (std::uint64_t n = chunk * k_samples_a_chunk; n < end; ++n) {
    const Bvh::Nearest nearest = bvh.nearest(sampler.sample(n), guess);
    guess = nearest.triangle;
    sums.add({nearest.squared, std::sqrt(nearest.squared), nearest.squared});
  }
  return sums;
}

}  // namespace

Distance measure_distance(const Mesh& from, const Mesh& to, const DistanceOptions& options) {
  if (options.samples == 0) throw UsageError("distances need at least one sample");
  const std::vector<double> before = areas_before(from, options.threads, "from");
  check_area(before, "from");
  check_area(areas_before(to, options.threads, "to"), "to");
  const Bvh bvh(to, options.threads);
  const AreaSampler sampler(from, before, options.samples);
  std::vector<DistanceSums> chunks(chunks_of(options.samples));
  parallel_for(chunks.size(), options.threads, [&](std::uint64_t chunk) {
    chunks[chunk] = measure_chunk(bvh, options.samples, chunk, sampler);
  });
  DistanceSums all;
  for (const DistanceSums& chunk : chunks) all.add(chunk);
  return all.over(options.samples);
}

SurfaceSamples sample_surface(const Mesh& mesh, const DistanceOptions& options) {
  const std::vector<double> before = areas_before(mesh, options.threads, "from");
  SurfaceSamples samples;
  samples.area = before.back();
  if (!(samples.area > 0)) return samples;
  AreaSampler sampler(mesh, before, options.samples);
  samples.points.reserve(options.samples);
  for (std::uint64_t n = 0; n < options.samples; ++n) samples.points.push_back(sampler.sample(n));
  return samples;
}

class DistanceMeter::Impl {
 public:
  Impl(const Mesh& to, unsigned threads) : index_(to, threads), threads_(threads) {}

  std::vector<Distance> measure_each(std::span<const Points> sets,
                                     std::span<double> of_points) const {
    std::vector<Vec3> all;
    for (const Points& set : sets) all.insert(all.end(), set.begin(), set.end());
    assert(of_points.empty() || of_points.size() == all.size());
    const std::vector<double> squared = squared_distances(all);
    std::vector<Distance> distances;
    std::size_t first = 0;
    for (const Points& set : sets) {
      distances.push_back(sum(std::span(squared).subspan(first, set.size())));
      first += set.size();
    }
    for (std::size_t i = 0; i < of_points.size(); ++i) of_points[i] = std::sqrt(squared[i]);
    return distances;
  }

  double farthest(Points points, double least) const {
    const double enough = least * least;
    double farthest = enough;
    std::uint32_t guess = 0;
    for (const std::uint32_t point : bvh().search_order(points)) {
      const Bvh::Nearest nearest = bvh().nearest(points[point], guess, farthest);
      guess = nearest.triangle;
      farthest = std::max(farthest, nearest.squared);
    }
    return farthest > enough ? std::sqrt(farthest) : least;
  }

  std::uint32_t nearest_triangle(Vec3 point) const { return bvh().nearest(point, 0).triangle; }

  std::vector<std::uint32_t> nearest_triangles(Points points) const {
    std::vector<std::uint32_t> triangles(points.size());
    find_nearest(points,
                 [&](std::size_t i, const Bvh::Nearest& found) { triangles[i] = found.triangle; });
    return triangles;
  }

  const TriangleIndex& index() const { return index_; }

 private:
  const Bvh& bvh() const { return index_.bvh(); }

  std::vector<double> squared_distances(Points points) const {
    std::vector<double> squared(points.size());
    find_nearest(points,
                 [&](std::size_t i, const Bvh::Nearest& found) { squared[i] = found.squared; });
    return squared;
  }

  /// Calls `found` from several threads.
  template <class Found>
  void find_nearest(Points points, const Found& found) const {
    constexpr std::size_t k_run = 1024;
    const std::vector<std::uint32_t> order = bvh().search_order(points);
    parallel_for((order.size() + k_run - 1) / k_run, threads_, [&](std::uint64_t run) {
      std::uint32_t guess = 0;
      const std::size_t end = std::min(order.size(), (run + 1) * k_run);
      for (std::size_t i = run * k_run; i < end; ++i) {
        const Bvh::Nearest nearest = bvh().nearest(points[order[i]], guess);
        guess = nearest.triangle;
        found(order[i], nearest);
      }
    });
  }

  static Distance sum(std::span<const double> squared) {
    DistanceSums sums;
    for (std::size_t begin = 0; begin < squared.size(); begin += k_samples_a_chunk) {
      DistanceSums chunk;
      const std::size_t end = std::min<std::size_t>(squared.size(), begin + k_samples_a_chunk);
      for (std::size_t i = begin; i < end; ++i) {
        chunk.add({squared[i], std::sqrt(squared[i]), squared[i]});
      }
      sums.add(chunk);
    }
    return sums.over(squared.size());
  }

  TriangleIndex index_;
  unsigned threads_;
};

DistanceMeter::DistanceMeter(const Mesh& to, unsigned threads)
    : impl_(std::make_unique<Impl>(to, threads)) {}
DistanceMeter::~DistanceMeter() = default;
DistanceMeter::DistanceMeter(DistanceMeter&&) noexcept = default;

Distance DistanceMeter::measure(Points points) const {
  return impl_->measure_each({&points, 1}, {}).front();
}

double DistanceMeter::farthest(Points points, double least) const {
  return impl_->farthest(points, least);
}

std::uint32_t DistanceMeter::nearest_triangle(Vec3 point) const {
  return impl_->nearest_triangle(point);
}

std::vector<std::uint32_t> DistanceMeter::nearest_triangles(Points points) const {
  return impl_->nearest_triangles(points);
}

const TriangleIndex& DistanceMeter::index() const {
  return impl_->index();
}

std::vector<Distance> DistanceMeter::measure_each(std::span<const Points> sets,
                                                  std::span<double> of_points) const {
  return impl_->measure_each(sets, of_points);
}

}  // namespace meshfarm
