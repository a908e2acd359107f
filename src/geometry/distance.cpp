// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"

namespace meshfarm {
namespace {

// Both fixed, so that nothing depends on the threads: chunks are what is summed up and handed out.
constexpr std::uint64_t k_samples_a_chunk = 1024;
constexpr std::size_t k_triangles_a_block = 128;

double area_of(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.positions[t[0]];
  return length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) / 2;
}

/// The area of all triangles before each block of them; the whole area at the end.
std::vector<double> areas_before(const Mesh& mesh, unsigned threads, const char* which) {
  const std::size_t count = mesh.triangles.size();
  const std::size_t blocks = (count + k_triangles_a_block - 1) / k_triangles_a_block;
  std::vector<double> before(blocks + 1, 0.0);
  parallel_for(blocks, threads, [&](std::uint64_t block) {
    const std::size_t end = std::min(count, (block + 1) * k_triangles_a_block);
    double sum = 0;
    for (std::size_t i = block * k_triangles_a_block; i < end; ++i) sum += area_of(mesh, i);
    before[block + 1] = sum;
  });
  for (std::size_t i = 1; i <= blocks; ++i) before[i] += before[i - 1];
  if (!std::isfinite(before.back())) {
    throw DataError(std::string("cannot measure distances: the mesh to measure ") + which +
                    " has coordinates that are not finite, or too large");
  }
  return before;
}

void check_area(const std::vector<double>& before, const char* which) {
  if (!(before.back() > 0)) {
    throw DataError(std::string("cannot measure distances: the mesh to measure ") + which +
                    " has no triangle of positive area");
  }
}

/// Sample n lies in the n-th of equal shares of the area, at a random place of it. Samples must be
/// asked for in rising order.
class Sampler {
 public:
  Sampler(const Mesh& mesh, const std::vector<double>& before, std::uint64_t samples)
      : mesh_(mesh), before_(before), share_(before.back() / static_cast<double>(samples)) {}

  Vec3 sample(std::uint64_t n) {
    seek((static_cast<double>(n) + random_unit(3 * n)) * share_);
    const Triangle& t = mesh_.triangles[triangle_];
    return random_place(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]], n);
  }

 private:
  // Jumps to the block that holds the place, then walks. Block sums and walked sums may differ in
  // the last bit, so a walk may end on the triangle beside: it is on the surface as well.
  void seek(double place) {
    const auto next = std::upper_bound(before_.begin() + 1, before_.end() - 1, place);
    const auto block = static_cast<std::size_t>(next - before_.begin()) - 1;
    if (block != block_) {
      block_ = block;
      triangle_ = block * k_triangles_a_block;
      walked_ = before_[block] + area_of(mesh_, triangle_);
    }
    const std::size_t end = std::min(mesh_.triangles.size(), (block + 1) * k_triangles_a_block) - 1;
    while (walked_ < place && triangle_ < end) walked_ += area_of(mesh_, ++triangle_);
  }

  const Mesh& mesh_;
  const std::vector<double>& before_;
  double share_;
  std::size_t block_ = static_cast<std::size_t>(-1);
  std::size_t triangle_ = 0;
  double walked_ = 0;  // area up to the end of triangle_
};

struct Sums {
  double squares = 0;
  double distances = 0;
  double max_square = 0;

  void add(const Sums& other) {
    squares += other.squares;
    distances += other.distances;
    max_square = std::max(max_square, other.max_square);
  }
  Distance over(std::uint64_t count) const {
    const auto samples = static_cast<double>(std::max<std::uint64_t>(1, count));
    return {std::sqrt(squares / samples), distances / samples, std::sqrt(max_square)};
  }
};

std::uint64_t chunks_of(std::uint64_t samples) {
  return (samples + k_samples_a_chunk - 1) / k_samples_a_chunk;
}

/// Measures one chunk of so many samples, which `point(n)` gives.
template <class Point>
Sums measure_chunk(const Bvh& bvh, std::uint64_t count, std::uint64_t chunk, Point point) {
  const std::uint64_t end = std::min(count, (chunk + 1) * k_samples_a_chunk);
  Sums sums;
  std::uint32_t guess = 0;
  for (std::uint64_t n = chunk * k_samples_a_chunk; n < end; ++n) {
    const Bvh::Nearest nearest = bvh.nearest(point(n), guess);
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
  const Sampler sampler(from, before, options.samples);
  std::vector<Sums> chunks(chunks_of(options.samples));
  parallel_for(chunks.size(), options.threads, [&](std::uint64_t chunk) {
    chunks[chunk] =
        measure_chunk(bvh, options.samples, chunk,
                      [own = sampler](std::uint64_t n) mutable { return own.sample(n); });
  });
  Sums all;
  for (const Sums& chunk : chunks) all.add(chunk);
  return all.over(options.samples);
}

SurfaceSamples sample_surface(const Mesh& mesh, const DistanceOptions& options) {
  const std::vector<double> before = areas_before(mesh, options.threads, "from");
  SurfaceSamples samples;
  samples.area = before.back();
  if (!(samples.area > 0)) return samples;
  Sampler sampler(mesh, before, options.samples);
  samples.points.reserve(options.samples);
  for (std::uint64_t n = 0; n < options.samples; ++n) samples.points.push_back(sampler.sample(n));
  return samples;
}

class DistanceMeter::Impl {
 public:
  Impl(const Mesh& to, unsigned threads) : bvh_(to, threads), threads_(threads) {}

  std::vector<Distance> measure_each(std::span<const Points> sets) const {
    std::vector<ChunkOfSet> chunks;
    for (std::size_t set = 0; set < sets.size(); ++set) {
      const std::uint64_t count = chunks_of(sets[set].size());
      for (std::uint64_t chunk = 0; chunk < count; ++chunk) chunks.push_back({set, chunk, {}});
    }
    parallel_for(chunks.size(), threads_, [&](std::uint64_t i) {
      const Points points = sets[chunks[i].set];
      chunks[i].sums = measure_chunk(bvh_, points.size(), chunks[i].chunk,
                                     [&](std::uint64_t n) { return points[n]; });
    });
    std::vector<Sums> sums(sets.size());
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
      const Bvh::Nearest nearest = bvh_.nearest(p, guess, enough);
      guess = nearest.triangle;
      farthest = std::max(farthest, nearest.squared);
    }
    return farthest > enough ? std::sqrt(farthest) : least;
  }

  std::vector<Vec3> beyond(Points points, double limit) const {
    std::vector<Vec3> beyond;
    std::uint32_t guess = 0;
    for (const Vec3& p : points) {
      const Bvh::Nearest nearest = bvh_.nearest(p, guess, limit * limit);
      guess = nearest.triangle;
      if (nearest.squared > limit * limit) beyond.push_back(p);
    }
    return beyond;
  }

  std::uint32_t nearest_triangle(Vec3 point) const { return bvh_.nearest(point, 0).triangle; }

 private:
  struct ChunkOfSet {
    std::size_t set = 0;
    std::uint64_t chunk = 0;
    Sums sums;
  };

  Bvh bvh_;
  unsigned threads_;
};

DistanceMeter::DistanceMeter(const Mesh& to, unsigned threads)
    : impl_(std::make_unique<Impl>(to, threads)) {}
DistanceMeter::~DistanceMeter() = default;
DistanceMeter::DistanceMeter(DistanceMeter&&) noexcept = default;

Distance DistanceMeter::measure(Points points) const {
  return impl_->measure_each({&points, 1}).front();
}

double DistanceMeter::farthest(Points points, double least) const {
  return impl_->farthest(points, least);
}

std::vector<Vec3> DistanceMeter::beyond(Points points, double limit) const {
  return impl_->beyond(points, limit);
}

std::uint32_t DistanceMeter::nearest_triangle(Vec3 point) const {
  return impl_->nearest_triangle(point);
}

std::vector<Distance> DistanceMeter::measure_each(std::span<const Points> sets) const {
  return impl_->measure_each(sets);
}

}  // namespace meshfarm
