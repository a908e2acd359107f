// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/atlas_flat.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include <meshfarm/util/parallel.hpp>

#include "geometry/texture/flat_overlap.hpp"

namespace meshfarm {
namespace {

std::vector<Flat> convex_hull(std::vector<Flat> points) {
  std::sort(points.begin(), points.end(),
            [](Flat a, Flat b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Flat> hull;
  const auto add_all = [&hull](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 &&
             cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  add_all(points.begin(), points.end());
  add_all(points.rbegin(), points.rend());
  return hull;
}

struct TurnedBox {
  Flat along{1, 0};  // of length 1: the box's first axis
  FlatBox box;       // in its axes
};

Flat turned(Flat p, Flat along) {
  return {dot(p, along), cross(along, p)};
}

/// The smallest box has a side along one of the hull's.
TurnedBox smallest_box(const std::vector<Flat>& hull) {
  constexpr std::size_t k_most_sides = 256;
  TurnedBox best;
  for (const Flat& p : hull) best.box.add(p);
  // Among equal boxes, the squarest is easiest to pack.
  const auto cost = [](const FlatBox& box) {
    const Flat size = box.hi - box.lo;
    return size.x * size.y + 0.01 * std::max(size.x * size.x, size.y * size.y);
  };
  const std::size_t stride = hull.size() / k_most_sides + 1;
  for (std::size_t i = 0; i < hull.size(); i += stride) {
    const Flat side = hull[(i + 1) % hull.size()] - hull[i];
    const double size = length(side);
    if (!(size > 0)) continue;
    TurnedBox now{side * (1 / size), {}};
    for (const Flat& p : hull) now.box.add(turned(p, now.along));
    if (cost(now.box) < cost(best.box)) best = now;
  }
  return best;
}

/// The frame onto which a chart is projected.
struct Plane {
  Vec3 origin, u, v;

  Flat project(Vec3 p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
};

Plane plane_across(Vec3 axis, Vec3 origin) {
  const double x = std::fabs(axis.x), y = std::fabs(axis.y), z = std::fabs(axis.z);
  const Vec3 other = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 u = cross(other, axis);
  const Vec3 unit = u * (1 / length(u));
  return {origin, unit, cross(axis, unit)};
}

/// Flattens one chart, into as many pieces as necessary.
class Flattener {
 public:
  Flattener(const ChartSurface& surface, std::span<const std::uint32_t> triangles)
      : surface_(surface), triangles_(triangles), piece_of_(triangles.size(), k_none) {}

  std::vector<FlatChart> run() {
    const Vec3 axis = chart_axis(surface_, triangles_, k_least_cosine);
    if (length(axis) > 0) {
      project(axis);
      divide();
    } else {
      project_each();
    }
    std::vector<FlatChart> made(pieces_);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      FlatChart& chart = made[piece_of_[i]];
      chart.triangles.push_back(triangles_[i]);
      chart.corners.push_back(corners_[i]);
    }
    for (std::uint32_t piece = 0; piece < pieces_; ++piece) finish(made[piece], piece);
    std::erase_if(made, [](const FlatChart& chart) { return chart.triangles.empty(); });
    return made;
  }

 private:
  static constexpr std::uint32_t k_none = 0xffffffff;

  void project(Vec3 axis) {
    const Plane plane = plane_across(axis, surface_.centers[triangles_.front()]);
    for (const std::uint32_t t : triangles_) corners_.push_back(projected(t, plane));
  }
  FlatTriangle projected(std::uint32_t triangle, const Plane& plane) const {
    FlatTriangle made;
    for (std::size_t k = 0; k < 3; ++k) {
      made[k] = plane.project(surface_.mesh.positions[surface_.mesh.triangles[triangle][k]]);
    }
    return made;
  }

  /// For charts where no direction suits all triangles: projects each along its own normal.
  void project_each() {
    for (const std::uint32_t t : triangles_) {
      const Vec3 axis = surface_.areas[t] > 0 ? surface_.normals[t] : Vec3{0, 0, 1};
      corners_.push_back(projected(t, plane_across(axis, surface_.centers[t])));
      piece_of_[corners_.size() - 1] = pieces_++;
    }
  }

  void divide() {
    const FlatOverlaps overlaps(corners_);
    if (overlaps.none()) {
      std::fill(piece_of_.begin(), piece_of_.end(), 0);
      pieces_ = 1;
      return;
    }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (piece_of_[i] == k_none) take_piece(i, overlaps);
    }
  }

  /// Takes the triangles that can be reached from `first` without overlapping those already taken,
  /// breadth-first.
  void take_piece(std::uint32_t first, const FlatOverlaps& overlaps) {
    const std::uint32_t piece = pieces_++;
    std::deque<std::uint32_t> open{first};
    while (!open.empty()) {
      const std::uint32_t i = open.front();
      open.pop_front();
      if (piece_of_[i] != k_none) continue;
      if (overlaps.any_with(i, [&](std::uint32_t k) { return piece_of_[k] == piece; })) continue;
      piece_of_[i] = piece;
      for (const std::uint32_t next : surface_.links[triangles_[i]]) {
        const std::uint32_t at = index_of(next);
        if (at != k_none && piece_of_[at] == k_none) open.push_back(at);
      }
    }
  }

  /// The index of a triangle of the mesh among this chart's triangles, which are sorted.
  std::uint32_t index_of(std::uint32_t triangle) const {
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), triangle);
    if (found == triangles_.end() || *found != triangle) return k_none;
    return static_cast<std::uint32_t>(found - triangles_.begin());
  }

  void finish(FlatChart& chart, std::uint32_t piece) {
    double solid = 0, flat = 0;
    for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
      solid += surface_.areas[chart.triangles[i]];
      flat += std::max(0.0, doubled_area(chart.corners[i]) / 2);
    }
    if (!(flat > 0) || !std::isfinite(solid / flat)) {
      chart.triangles.clear();
      return;
    }
    set_outline(chart, piece);
    std::vector<Flat> points;
    for (const auto& [a, b] : chart.outline) points.insert(points.end(), {a, b});
    const TurnedBox turn = smallest_box(convex_hull(std::move(points)));
    const double scale = std::sqrt(solid / flat);
    const auto put = [&](Flat& p) { p = (turned(p, turn.along) - turn.box.lo) * scale; };
    for (FlatTriangle& t : chart.corners) std::for_each(t.begin(), t.end(), put);
    for (auto& side : chart.outline) std::for_each(side.begin(), side.end(), put);
    chart.size = (turn.box.hi - turn.box.lo) * scale;
  }

  void set_outline(FlatChart& chart, std::uint32_t piece) const {
    for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = index_of(surface_.links[chart.triangles[i]][k]);
        if (next != k_none && piece_of_[next] == piece) continue;
        chart.outline.push_back({chart.corners[i][k], chart.corners[i][(k + 1) % 3]});
      }
    }
  }

  const ChartSurface& surface_;
  std::span<const std::uint32_t> triangles_;
  std::vector<FlatTriangle> corners_;
  std::vector<std::uint32_t> piece_of_;
  std::uint32_t pieces_ = 0;
};

}  // namespace

std::vector<FlatChart> flatten_charts(const ChartSurface& surface, const Charts& charts,
                                      unsigned threads) {
  const ChartLists lists(charts.chart_of, charts.count);
  std::vector<std::vector<FlatChart>> made(charts.count);
  parallel_for(charts.count, threads, [&](std::uint64_t chart) {
    made[chart] = Flattener(surface, lists.of(static_cast<std::uint32_t>(chart))).run();
  });
  std::vector<FlatChart> all;
  for (auto& some : made) std::move(some.begin(), some.end(), std::back_inserter(all));
  return all;
}

}  // namespace meshfarm
