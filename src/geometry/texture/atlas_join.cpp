// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Charts, the smallest first, are joined with the neighbour with which they share the longest
// border, if the normals of both lie within one cone. The cone is wider for tiny charts, which
// would waste more in margins than their triangles lose by the projection.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <meshfarm/geometry/atlas.hpp>

#include "geometry/texture/atlas_charts.hpp"

namespace meshfarm {
namespace {

constexpr double k_join_cosine = 0.574;       // 55 degrees
constexpr double k_tiny_join_cosine = 0.259;  // 75 degrees
/// Charts that are not tiny must share at least this part of the smaller one's border.
constexpr double k_least_shared = 0.2;

class Joiner {
 public:
  Joiner(const ChartSurface& surface, double tiny_area, Charts& charts)
      : surface_(surface), tiny_area_(tiny_area), charts_(charts), list_(charts.count) {
    const ChartLists lists(charts.chart_of, charts.count);
    for (std::uint32_t c = 0; c < charts.count; ++c) {
      const auto triangles = lists.of(c);
      list_[c].triangles.assign(triangles.begin(), triangles.end());
      measure(c);
    }
  }

  void run() {
    for (std::uint32_t c = 0; c < list_.size(); ++c) queue_.insert({list_[c].area, c});
    while (!queue_.empty()) {
      const std::uint32_t chart = queue_.begin()->second;
      queue_.erase(queue_.begin());
      join_one(chart);
    }
    renumber();
  }

 private:
  struct Item {
    std::vector<std::uint32_t> triangles;
    std::map<std::uint32_t, double> neighbours;  // with the length of the border
    double border = 0;                           // all of it
    double area = 0;
    Vec3 normals;        // summed by area
    double spread = -1;  // lowest cosine of a normal with the axis; -1: unknown
  };

  static double cosine_of_sum(double a, double b) {
    const double sines = std::sqrt(std::max(0.0, 1 - a * a)) * std::sqrt(std::max(0.0, 1 - b * b));
    return a * b - sines;
  }

  void measure(std::uint32_t chart) {
    Item& item = list_[chart];
    item.spread = 1;
    for (const std::uint32_t t : item.triangles) {
      item.area += surface_.areas[t];
      item.normals = item.normals + surface_.normals[t] * surface_.areas[t];
      const Triangle& corners = surface_.mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = surface_.links[t][k];
        const std::uint32_t other = next == k_no_triangle ? k_no_chart : charts_.chart_of[next];
        if (other == chart) continue;
        const double edge = length(surface_.mesh.positions[corners[k]] -
                                   surface_.mesh.positions[corners[(k + 1) % 3]]);
        item.border += edge;
        if (other != k_no_chart) item.neighbours[other] += edge;
      }
    }
    item.spread = lowest_cosine(item, axis_of(item.normals), -1);
  }

  static Vec3 axis_of(Vec3 normals) {
    const double all = length(normals);
    return all > 0 ? normals * (1 / all) : Vec3{};
  }

  /// May stop early once it is below `enough`.
  double lowest_cosine(const Item& item, Vec3 axis, double enough) const {
    double lowest = 1;
    for (const std::uint32_t t : item.triangles) {
      if (!(surface_.areas[t] > 0)) continue;
      lowest = std::min(lowest, dot(surface_.normals[t], axis));
      if (lowest < enough) break;
    }
    return lowest;
  }

  /// The lowest cosine of a chart's normals with another axis, or a lower bound if that suffices.
  double spread_about(const Item& item, Vec3 axis, double enough) const {
    const double turned = std::clamp(dot(axis_of(item.normals), axis), -1.0, 1.0);
    if (item.spread > 0 && turned > 0) {
      const double bound = cosine_of_sum(item.spread, turned);
      if (bound >= enough) return bound;
    }
    return lowest_cosine(item, axis, enough);
  }

  void join_one(std::uint32_t chart) {
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const auto& [other, border] : list_[chart].neighbours) order.emplace_back(-border, other);
    std::sort(order.begin(), order.end());
    for (const auto& [minus_border, other] : order) {
      if (try_join(chart, other, -minus_border)) return;
    }
  }

  bool try_join(std::uint32_t chart, std::uint32_t other, double border) {
    const Item& a = list_[chart];
    const Item& b = list_[other];
    const bool is_tiny = std::min(a.area, b.area) < tiny_area_;
    if (!is_tiny && border < k_least_shared * std::min(a.border, b.border)) return false;
    const Vec3 axis = axis_of(a.normals + b.normals);
    const double least = is_tiny ? k_tiny_join_cosine : k_join_cosine;
    const double of_a = spread_about(a, axis, least);
    if (of_a < least) return false;
    const double of_b = spread_about(b, axis, least);
    if (of_b < least) return false;
    unite(chart, other, std::min(of_a, of_b));
    return true;
  }

  /// The chart with more triangles absorbs the other.
  void unite(std::uint32_t a, std::uint32_t b, double spread) {
    if (list_[a].triangles.size() < list_[b].triangles.size()) std::swap(a, b);
    Item& to = list_[a];
    Item from = std::exchange(list_[b], {});
    queue_.erase({to.area, a});
    queue_.erase({from.area, b});
    to.triangles.insert(to.triangles.end(), from.triangles.begin(), from.triangles.end());
    to.border += from.border - 2 * to.neighbours[b];
    to.area += from.area;
    to.normals = to.normals + from.normals;
    to.spread = spread;
    to.neighbours.erase(b);
    for (const auto& [other, border] : from.neighbours) {
      if (other == a) continue;
      to.neighbours[other] += border;
      list_[other].neighbours.erase(b);
      list_[other].neighbours[a] += border;
    }
    queue_.insert({to.area, a});
  }

  void renumber() {
    charts_.count = 0;
    for (const Item& item : list_) {
      if (item.triangles.empty()) continue;
      for (const std::uint32_t t : item.triangles) charts_.chart_of[t] = charts_.count;
      ++charts_.count;
    }
  }

  const ChartSurface& surface_;
  double tiny_area_;
  Charts& charts_;
  std::vector<Item> list_;
  std::set<std::pair<double, std::uint32_t>> queue_;  // area, chart
};

}  // namespace

void join_charts(const ChartSurface& surface, double tiny_area, Charts& charts) {
  Joiner(surface, tiny_area, charts).run();
}

}  // namespace meshfarm
