// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <meshfarm/geometry/point_meter.hpp>

#include "geometry/bvh.hpp"
#include "geometry/point_grid.hpp"
#include "geometry/point_tree.hpp"

namespace meshfarm {
namespace {

/// Where no grid helps, runs of this many triangles are first tested by their common box.
constexpr std::size_t k_run = 32;
/// At least this many triangles are worth a hierarchy.
constexpr std::size_t k_worth_a_tree = 256;
/// Search a little beyond the known distance, so that the known place is found again.
constexpr double k_a_little_more = 1 + 0x1p-20;
/// Shares of the distance between vertices: a slightly larger reach costs nothing, nor do larger
/// cells.
constexpr double k_least_reach = 0.25;
constexpr double k_meter_cell = 2;

}  // namespace

Vec3 middle_of_longest_side(std::span<const Vec3> positions, const Triangle& triangle) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double squared =
        squared_length(positions[triangle[(k + 1) % 3]] - positions[triangle[k]]);
    if (squared > most) {
      most = squared;
      longest = k;
    }
  }
  return positions[triangle[longest]] * 0.5 + positions[triangle[(longest + 1) % 3]] * 0.5;
}

std::vector<Vec3> middles_of_longest_sides(std::span<const Vec3> positions,
                                           std::span<const Triangle> triangles) {
  std::vector<Vec3> middles;
  middles.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    if (!has_no_area(positions, t)) middles.push_back(middle_of_longest_side(positions, t));
  }
  return middles;
}

std::vector<Vec3> vertices_of_surface(std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles) {
  std::vector<std::uint8_t> is_there(positions.size(), 0);
  for_corners_with_area(positions, triangles, [&](std::uint32_t v) { is_there[v] = 1; });
  std::vector<Vec3> vertices;
  vertices.reserve(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (is_there[v] != 0) vertices.push_back(positions[v]);
  }
  return vertices;
}

class PointMeter::Impl {
 public:
  Impl(std::span<const Vec3> points, const PointMeterHints& hints)
      : hints_(hints),
        reach_(hints.all_are_beyond
                   ? 0
                   : k_a_little_more * std::max(hints.usual, k_least_reach * hints.spacing)),
        pass_(hints.all_are_beyond ? 1 : 0),
        points_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points_[i].place = points[i];
      points_[i].squared = reach_ * reach_;
    }
  }

  bool begin_pass() {
    std::vector<std::uint32_t> searching;
    if (++pass_ == 1) {
      searching.resize(points_.size());
      std::iota(searching.begin(), searching.end(), 0U);
      grid_.emplace(points_, reach_, k_meter_cell * hints_.spacing);
    } else if (pass_ == 2) {
      searching = begin_last_pass();
    }
    tree_.emplace(points_, searching);
    return !searching.empty();
  }

  bool wants(const Box& box) const { return tree_->wants(box); }

  void show(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    if (!grid_) return show_to_tree(positions, triangles);
    if (grid_->is_crowded() && triangles.size() >= k_worth_a_tree)
      return show_at_once(positions, triangles);
    // With few triangles it is cheaper not to compute a key for each vertex.
    if (positions.size() > 2 * triangles.size()) {
      for (const auto& [a, b, c] : triangles) {
        offer(positions[a], positions[b], positions[c], grid_->key_of(positions[a]),
              grid_->key_of(positions[b]), grid_->key_of(positions[c]));
      }
      return;
    }
    const std::vector<std::uint64_t> keys = keys_of(positions);
    for (const auto& [a, b, c] : triangles) {
      offer(positions[a], positions[b], positions[c], keys[a], keys[b], keys[c]);
    }
  }

  std::vector<double> distances() const {
    std::vector<double> distances;
    distances.reserve(points_.size());
    for (const SearchingPoint& point : points_) distances.push_back(std::sqrt(point.known()));
    return distances;
  }

 private:
  /// Points without a near triangle are no farther from the surface than from its known points.
  std::vector<std::uint32_t> begin_last_pass() {
    grid_.reset();
    std::vector<std::uint32_t> searching;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (points_[i].known() >= reach_ * reach_) searching.push_back(i);
    }
    if (searching.empty()) return searching;
    Mesh known;
    known.positions.assign(hints_.surface.begin(), hints_.surface.end());
    for (std::uint32_t i = 0; i < known.positions.size(); ++i) known.triangles.push_back({i, i, i});
    const Bvh bvh(known, 0);
    std::uint32_t guess = 0;
    for (const std::uint32_t i : searching) {
      const Bvh::Nearest nearest = bvh.nearest(points_[i].place, guess);
      guess = nearest.triangle;
      points_[i].squared = nearest.squared * k_a_little_more;
    }
    return searching;
  }

  std::vector<std::uint64_t> keys_of(std::span<const Vec3> positions) const {
    std::vector<std::uint64_t> keys;
    keys.reserve(positions.size());
    for (const Vec3& p : positions) keys.push_back(grid_->key_of(p));
    return keys;
  }

  /// Puts the triangles that are near some point into their own hierarchy.
  void show_at_once(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    const std::vector<std::uint64_t> keys = keys_of(positions);
    std::vector<Triangle> near;
    Box box;
    for (const Triangle& t : triangles) {
      if (grid_->reach_of(keys[t[0]], keys[t[1]], keys[t[2]]) == PointGrid::Reach::none) continue;
      near.push_back(t);
      for (const std::uint32_t v : t) box.add(positions[v]);
    }
    if (!near.empty()) tree_->offer(Bvh(positions, near, 1), box);
  }

  void offer(Vec3 a, Vec3 b, Vec3 c, std::uint64_t key_a, std::uint64_t key_b,
             std::uint64_t key_c) {
    const PointGrid::Reach reach = grid_->reach_of(key_a, key_b, key_c);
    if (reach == PointGrid::Reach::none) return;
    const OfferedTriangle triangle(a, b, c);
    reach == PointGrid::Reach::some ? grid_->offer(triangle) : tree_->offer(triangle);
  }

  void show_to_tree(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    for (std::size_t first = 0; first < triangles.size(); first += k_run) {
      const auto run = triangles.subspan(first, std::min(k_run, triangles.size() - first));
      Box box;
      for (const Triangle& t : run) {
        for (const std::uint32_t v : t) box.add(positions[v]);
      }
      if (!tree_->wants(box)) continue;
      for (const auto& [a, b, c] : run) {
        tree_->offer(OfferedTriangle(positions[a], positions[b], positions[c]));
      }
    }
  }

  PointMeterHints hints_;
  double reach_;  // of the first pass
  int pass_;      // the current one
  std::vector<SearchingPoint> points_;
  std::optional<PointGrid> grid_;  // of the first pass
  std::optional<PointTree> tree_;  // of the points searching in this pass
};

PointMeter::PointMeter(std::span<const Vec3> points, const PointMeterHints& hints)
    : impl_(std::make_unique<Impl>(points, hints)) {}
PointMeter::~PointMeter() = default;
PointMeter::PointMeter(PointMeter&&) noexcept = default;

bool PointMeter::begin_pass() {
  return impl_->begin_pass();
}

bool PointMeter::wants(const Box& box) const {
  return impl_->wants(box);
}

void PointMeter::show(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  impl_->show(positions, triangles);
}

std::vector<double> PointMeter::distances() const {
  return impl_->distances();
}

}  // namespace meshfarm
