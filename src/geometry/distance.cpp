// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/area_sampler.hpp"
#include "geometry/bvh.hpp"
#include "geometry/distance_sums.hpp"

namespace meshfarm {
namespace {

/// Measures one chunk of so many samples, which `point(n)` gives; `take(n, distance)` is told each.
template <class Point, class Take>
DistanceSums measure_chunk(const Bvh& bvh, std::uint64_t count, std::uint64_t chunk, Point point,
                           const Take& take) {
  const std::uint64_t end = std::min(count, (chunk + 1) * k_samples_a_chunk);
  DistanceSums sums;
  std::uint32_t guess = 0;
  for (std::uint64_t n = chunk * k_samples_a_chunk; n < end; ++n) {
    const Bvh::Nearest nearest = bvh.nearest(point(n), guess);
    guess = nearest.triangle;
    const double distance = std::sqrt(nearest.squared);
    sums.add({nearest.squared, distance, nearest.squared});
    take(n, distance);
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
    chunks[chunk] = measure_chunk(
        bvh, options.samples, chunk,
        [own = sampler](std::uint64_t n) mutable { return own.sample(n); },
        [](std::uint64_t, double) {});
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
    std::vector<ChunkOfSet> chunks;
    std::vector<std::size_t> first = {0};  // point of each set, among all
    for (const Points& set : sets) first.push_back(first.back() + set.size());
    for (std::size_t set = 0; set < sets.size(); ++set) {
      const std::uint64_t count = chunks_of(sets[set].size());
      for (std::uint64_t chunk = 0; chunk < count; ++chunk) chunks.push_back({set, chunk, {}});
    }
    parallel_for(chunks.size(), threads_, [&](std::uint64_t i) {
      const std::size_t set = chunks[i].set;
      const Points points = sets[set];
      chunks[i].sums = measure_chunk(
          index_.bvh(), points.size(), chunks[i].chunk, [&](std::uint64_t n) { return points[n]; },
          [&](std::uint64_t n, double distance) {
            if (!of_points.empty()) of_points[first[set] + n] = distance;
          });
    });
    std::vector<DistanceSums> sums(sets.size());
    for (const ChunkOfSet& each : chunks) sums[each.set].add(each.sums);
    std::vector<Distance> distances;
    for (std::size_t set = 0; set < sets.size(); ++set) {
      distances.push_back(sums[set].over(sets[set].size()));
    }
    return distances;
  }

  double farthest(Points points, double least) const {
    const double enough = least * least;
    double farthest = enough;
    std::uint32_t guess = 0;
    for (const Vec3& p : points) {
      const Bvh::Nearest nearest = index_.bvh().nearest(p, guess, enough);
      guess = nearest.triangle;
      farthest = std::max(farthest, nearest.squared);
    }
    return farthest > enough ? std::sqrt(farthest) : least;
  }

  std::uint32_t nearest_triangle(Vec3 point) const {
    return index_.bvh().nearest(point, 0).triangle;
  }
  const TriangleIndex& index() const { return index_; }

 private:
  struct ChunkOfSet {
    std::size_t set = 0;
    std::uint64_t chunk = 0;
    DistanceSums sums;
  };

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

const TriangleIndex& DistanceMeter::index() const {
  return impl_->index();
}

std::vector<Distance> DistanceMeter::measure_each(std::span<const Points> sets,
                                                  std::span<double> of_points) const {
  return impl_->measure_each(sets, of_points);
}

}  // namespace meshfarm
