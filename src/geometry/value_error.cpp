// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/quantile.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/area_sampler.hpp"
#include "geometry/bvh.hpp"
#include "geometry/distance_sums.hpp"
#include "geometry/farthest_point.hpp"
#include "geometry/random_unit.hpp"
#include "geometry/turned.hpp"

namespace meshfarm {
namespace {

struct ValueSums {
  double squares = 0;
  double sum = 0;
  double max = 0;
  std::uint64_t samples = 0;

  void add(const ValueSums& other) {
    squares += other.squares;
    sum += other.sum;
    max = std::max(max, other.max);
    samples += other.samples;
  }
  /// The difference at a point, or in one of its columns.
  void add_difference(double difference) {
    squares += difference * difference;
    sum += difference;
    max = std::max(max, difference);
  }
  ValueError over(const ValueGroup& group) const {
    const std::size_t differences = group.kind == ValueKind::direction ? 1 : group.columns;
    const auto count = static_cast<double>(std::max<std::uint64_t>(1, samples * differences));
    return {std::sqrt(squares / count), sum / count, max, samples};
  }
};

/// One entry per sample.
struct Sampled {
  std::vector<double> distances;
  std::vector<float> degrees;  // below 0 where a triangle has no normal
};

struct ChunkSums {
  DistanceSums distance;
  std::vector<ValueSums> values;
  std::uint64_t other_labels = 0;
  FarPoint farthest;
};

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

void compare(const ValueGroup& group, std::span<const double> a, std::span<const double> b,
             ValueSums& sums) {
  if (group.kind == ValueKind::direction) {
    const double degrees = degrees_between({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
    if (!std::isfinite(degrees)) return;
    sums.add_difference(degrees);
  } else {
    if (!all_finite(a) || !all_finite(b)) return;
    for (std::size_t i = 0; i < a.size(); ++i) sums.add_difference(std::abs(a[i] - b[i]));
  }
  ++sums.samples;
}

class Comparer {
 public:
  Comparer(const ValuedMesh& from, const ValuedMesh& to, std::span<const ValueGroup> groups,
           const Bvh& bvh)
      : from_(from), to_(to), groups_(groups), bvh_(bvh) {
    for (const ValueGroup& group : groups) columns_ += group.columns;
    has_labels_ = !from.labels.empty() && !to.labels.empty();
  }

  /// Fills in the samples of the chunk.
  ChunkSums compare_chunk(AreaSampler sampler, std::uint64_t chunk, Sampled& sampled) const {
    ChunkSums sums{{}, std::vector<ValueSums>(groups_.size()), 0, {}};
    std::vector<double> here(columns_);
    std::vector<double> there(columns_);
    const std::uint64_t samples = sampled.distances.size();
    const std::uint64_t end = std::min(samples, (chunk + 1) * k_samples_a_chunk);
    std::uint32_t guess = 0;
    for (std::uint64_t n = chunk * k_samples_a_chunk; n < end; ++n) {
      const Vec3 point = sampler.sample(n);
      const Bvh::Nearest nearest = bvh_.nearest(point, guess);
      guess = nearest.triangle;
      sampled.distances[n] = std::sqrt(nearest.squared);
      sums.distance.add({nearest.squared, sampled.distances[n], nearest.squared});
      const auto source = static_cast<std::uint32_t>(sampler.triangle());
      if (sampled.distances[n] > sums.farthest.distance) {
        sums.farthest = {sampled.distances[n], source};
      }
      if (has_labels_ && from_.labels[source] != to_.labels[guess]) ++sums.other_labels;
      blend(from_, source, random_shares(n), here);
      const Triangle& t = to_.mesh.triangles[guess];
      const std::vector<Vec3>& at = to_.mesh.positions;
      const auto shares = nearest_shares(point, at[t[0]], at[t[1]], at[t[2]]);
      sampled.degrees[n] = static_cast<float>(
          degrees_turned(to_.mesh, bvh_, point, normal_of(from_.mesh, source), nearest, shares));
      blend(to_, guess, shares, there);
      compare_all(here, there, sums.values);
    }
    return sums;
  }

 private:
  void blend(const ValuedMesh& mesh, std::uint32_t triangle, const std::array<double, 3>& shares,
             std::span<double> values) const {
    if (mesh.values_at) return mesh.values_at(triangle, shares, values);
    std::fill(values.begin(), values.end(), 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      // A corner without a share may have a value that is not finite.
      if (shares[k] == 0) continue;
      const auto of_vertex =
          mesh.values.subspan(mesh.mesh.triangles[triangle][k] * columns_, columns_);
      for (std::size_t i = 0; i < columns_; ++i) {
        values[i] += shares[k] * static_cast<double>(of_vertex[i]);
      }
    }
  }

  void compare_all(std::span<const double> a, std::span<const double> b,
                   std::vector<ValueSums>& sums) const {
    std::size_t first = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::size_t count = groups_[g].columns;
      compare(groups_[g], a.subspan(first, count), b.subspan(first, count), sums[g]);
      first += count;
    }
  }

  const ValuedMesh& from_;
  const ValuedMesh& to_;
  std::span<const ValueGroup> groups_;
  std::size_t columns_ = 0;
  bool has_labels_ = false;
  const Bvh& bvh_;
};

NormalDeviation deviation_of(std::vector<float>& degrees) {
  std::erase_if(degrees, [](float value) { return value < 0; });
  if (degrees.empty()) return {};
  double squares = 0;
  for (const float value : degrees) {
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const auto over =
      std::count_if(degrees.begin(), degrees.end(), [](float value) { return value > 90; });
  const auto samples = static_cast<double>(degrees.size());
  return {std::sqrt(squares / samples), static_cast<double>(quantile(std::span(degrees), 0.95)),
          static_cast<double>(over) / samples};
}

}  // namespace

DistanceQuantiles quantiles_of(std::span<double> distances) {
  return {quantile(distances, 0.95), quantile(distances, 0.99)};
}

SurfaceError measure_error(const ValuedMesh& from, const ValuedMesh& to,
                           std::span<const ValueGroup> groups, const DistanceOptions& options,
                           const std::function<void(const TriangleIndex&)>& with_index) {
  if (options.samples == 0) throw UsageError("distances need at least one sample");
  const std::vector<double> before = areas_before(from.mesh, options.threads, "from");
  check_area(before, "from");
  check_area(areas_before(to.mesh, options.threads, "to"), "to");
  const TriangleIndex index(to.mesh, options.threads);
  const Comparer comparer(from, to, groups, index.bvh());
  const AreaSampler sampler(from.mesh, before, options.samples);
  std::vector<ChunkSums> chunks(chunks_of(options.samples));
  Sampled sampled{std::vector<double>(options.samples), std::vector<float>(options.samples)};
  parallel_for(chunks.size(), options.threads, [&](std::uint64_t chunk) {
    chunks[chunk] = comparer.compare_chunk(sampler, chunk, sampled);
  });
  DistanceSums distance;
  std::vector<ValueSums> sums(groups.size());
  std::uint64_t other_labels = 0;
  std::vector<FarPoint> far;
  for (const ChunkSums& chunk : chunks) {
    distance.add(chunk.distance);
    far.push_back(chunk.farthest);
    other_labels += chunk.other_labels;
    for (std::size_t g = 0; g < groups.size(); ++g) sums[g].add(chunk.values[g]);
  }
  SurfaceError error;
  error.distance = distance.over(options.samples);
  error.distance.max = find_farthest(from.mesh, index.bvh(), far, options.threads);
  if (with_index) with_index(index);
  error.quantiles = quantiles_of(sampled.distances);
  error.normals = deviation_of(sampled.degrees);
  error.other_labels = static_cast<double>(other_labels) / static_cast<double>(options.samples);
  for (std::size_t g = 0; g < groups.size(); ++g) error.values.push_back(sums[g].over(groups[g]));
  return error;
}

}  // namespace meshfarm
