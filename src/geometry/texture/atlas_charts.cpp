// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Regions grow from seeds along shortest paths, where triangles count as longer the farther their
// normals are from the axis. Then each chart's middle becomes its seed and all regions grow again,
// as in Cohen-Steiner et al., Variational Shape Approximation (2004).
#include "geometry/texture/atlas_charts.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

/// A chart grows over normals within 50 degrees of its axis.
constexpr double k_growth_cosine = 0.643;
constexpr int k_rounds = 3;
/// Path lengths grow by this times 1 - cosine of the normals' deviation.
constexpr double k_deviation_weight = 6;

Vec3 unit(Vec3 v) {
  const double all = length(v);
  return all > 0 ? v * (1 / all) : Vec3{};
}

struct Seed {
  std::uint32_t triangle;
  Vec3 axis;
};

/// A triangle that a chart may take next.
struct Step {
  double way;
  std::uint32_t triangle;
  std::uint32_t chart;
  /// Reversed, so that std::priority_queue yields the shortest path.
  friend bool operator<(const Step& a, const Step& b) {
    return std::tie(a.way, a.triangle, a.chart) > std::tie(b.way, b.triangle, b.chart);
  }
};

class Growth {
 public:
  explicit Growth(const ChartSurface& surface)
      : surface_(surface), chart_of_(surface.triangles(), k_no_chart) {}

  /// Grows all seeds at once, each along its axis; then adds charts for triangles that none of them
  /// reaches.
  Charts grow(std::span<const Seed> seeds) {
    for (const Seed& seed : seeds) start(seed);
    run([this](std::uint32_t chart) { return axes_[chart]; });
    for (std::uint32_t t = 0; t < chart_of_.size(); ++t) {
      if (chart_of_[t] == k_no_chart && surface_.areas[t] > 0) grow_alone(t);
    }
    return {std::move(chart_of_), static_cast<std::uint32_t>(axes_.size())};
  }

 private:
  void start(const Seed& seed) {
    steps_.push({0, seed.triangle, static_cast<std::uint32_t>(axes_.size())});
    axes_.push_back(seed.axis);
  }

  /// Grows one chart whose axis follows the mean of its normals.
  void grow_alone(std::uint32_t triangle) {
    start({triangle, surface_.normals[triangle]});
    Vec3 sum;
    run([this, &sum](std::uint32_t) { return length(sum) > 0 ? unit(sum) : axes_.back(); },
        [this, &sum](std::uint32_t t) { sum = sum + surface_.normals[t] * surface_.areas[t]; });
  }

  template <typename AxisOf, typename Taken>
  void run(const AxisOf& axis_of, const Taken& taken) {
    while (!steps_.empty()) {
      const Step step = steps_.top();
      steps_.pop();
      if (chart_of_[step.triangle] != k_no_chart) continue;
      const Vec3 axis = axis_of(step.chart);
      if (deviation(step.triangle, axis) > 1 - k_growth_cosine && step.way > 0) continue;
      chart_of_[step.triangle] = step.chart;
      taken(step.triangle);
      for (const std::uint32_t next : surface_.links[step.triangle]) {
        if (next != k_no_triangle && chart_of_[next] == k_no_chart) offer(step, next, axis);
      }
    }
  }
  template <typename AxisOf>
  void run(const AxisOf& axis_of) {
    run(axis_of, [](std::uint32_t) {});
  }

  void offer(const Step& from, std::uint32_t next, Vec3 axis) {
    const double turn = deviation(next, axis);
    if (turn > 1 - k_growth_cosine) return;
    const double apart = length(surface_.centers[next] - surface_.centers[from.triangle]);
    steps_.push({from.way + apart * (1 + k_deviation_weight * turn), next, from.chart});
  }

  /// 1 - cosine. A triangle without area fits everywhere.
  double deviation(std::uint32_t triangle, Vec3 axis) const {
    return surface_.areas[triangle] > 0 ? 1 - dot(surface_.normals[triangle], axis) : 0;
  }

  const ChartSurface& surface_;
  std::vector<std::uint32_t> chart_of_;
  std::vector<Vec3> axes_;
  std::priority_queue<Step> steps_;
};

/// The middle of each chart that is not tiny.
std::vector<Seed> middles(const ChartSurface& surface, const Charts& charts, double tiny_area) {
  const ChartLists lists(charts.chart_of, charts.count);
  std::vector<Seed> seeds;
  for (std::uint32_t chart = 0; chart < charts.count; ++chart) {
    Vec3 normals, centers;
    double area = 0;
    for (const std::uint32_t t : lists.of(chart)) {
      normals = normals + surface.normals[t] * surface.areas[t];
      centers = centers + surface.centers[t] * surface.areas[t];
      area += surface.areas[t];
    }
    if (!(area >= tiny_area) || !(area > 0)) continue;
    const Vec3 axis = unit(normals), middle = centers * (1 / area);
    Seed seed{k_no_triangle, axis};
    double least = HUGE_VAL;
    for (const std::uint32_t t : lists.of(chart)) {
      const double cosine = dot(surface.normals[t], axis);
      if (cosine < k_growth_cosine) continue;
      const double apart = squared_length(surface.centers[t] - middle) * (2 - cosine);
      if (!(apart < least)) continue;
      least = apart;
      seed.triangle = t;
    }
    if (seed.triangle != k_no_triangle) seeds.push_back(seed);
  }
  return seeds;
}

}  // namespace

ChartSurface chart_surface(const Mesh& mesh, unsigned threads) {
  const std::size_t count = mesh.triangles.size();
  ChartSurface made{mesh, {}, {}, {}, {}};
  made.normals.resize(count);
  made.areas.resize(count);
  made.centers.resize(count);
  constexpr std::uint64_t k_chunk = 4096;
  parallel_for((count + k_chunk - 1) / k_chunk, threads, [&](std::uint64_t chunk) {
    for (std::size_t t = chunk * k_chunk; t < std::min(count, (chunk + 1) * k_chunk); ++t) {
      const auto [a, b, c] = mesh.triangles[t];
      const Vec3 p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
      const Vec3 normal = cross(q - p, r - p);
      const double twice = length(normal);
      made.centers[t] = (p + q + r) * (1.0 / 3);
      if (!(twice > 0) || !std::isfinite(1 / twice)) continue;
      made.normals[t] = normal * (1 / twice);
      made.areas[t] = twice / 2;
    }
  });
  made.links = link_triangles(mesh, made.normals);
  return made;
}

ChartLists::ChartLists(std::span<const std::uint32_t> chart_of, std::uint32_t charts)
    : first_(charts + std::size_t{2}, 0) {
  for (const std::uint32_t chart : chart_of) {
    if (chart != k_no_chart) ++first_[chart + std::size_t{2}];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  triangles_.resize(first_.back());
  for (std::size_t t = 0; t < chart_of.size(); ++t) {
    if (chart_of[t] == k_no_chart) continue;
    triangles_[first_[chart_of[t] + std::size_t{1}]++] = static_cast<std::uint32_t>(t);
  }
  first_.pop_back();
}

Vec3 chart_axis(const ChartSurface& surface, std::span<const std::uint32_t> triangles,
                double least) {
  constexpr int k_tries = 16;
  Vec3 sum;
  for (const std::uint32_t t : triangles) sum = sum + surface.normals[t] * surface.areas[t];
  Vec3 axis = unit(sum);
  for (int i = 0; i < k_tries; ++i) {
    double lowest = 2;
    Vec3 far;
    for (const std::uint32_t t : triangles) {
      if (!(surface.areas[t] > 0)) continue;
      const double cosine = dot(surface.normals[t], axis);
      if (cosine < lowest) {
        lowest = cosine;
        far = surface.normals[t];
      }
    }
    if (lowest >= least) return axis;
    axis = unit(axis + far * (1.05 * (least - lowest) + 0.01));
  }
  return {};
}

Charts make_charts(const ChartSurface& surface, double tiny_area) {
  Charts charts = Growth(surface).grow({});
  join_charts(surface, tiny_area, charts);
  for (int i = 0; i < k_rounds; ++i) {
    charts = Growth(surface).grow(middles(surface, charts, tiny_area));
    join_charts(surface, tiny_area, charts);
  }
  return charts;
}

}  // namespace meshfarm
