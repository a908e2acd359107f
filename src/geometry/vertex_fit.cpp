// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <unordered_map>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/place_hash.hpp>
#include <meshfarm/geometry/vertex_fit.hpp>

#include "geometry/turned.hpp"

namespace meshfarm {
namespace {

/// A vertex is held to its place with the weight of this many points of mean weight.
constexpr double k_points_that_hold = 2.4;
/// Each sweep is damped by this share of the pull on a vertex, most noticeably along planes.
constexpr double k_slow_down = 0.01;
/// Each sweep is cheap compared with the search for the nearest places.
constexpr int k_sweeps = 4;
/// A point nearer than this share of a triangle's width counts as on it.
constexpr double k_exact = 0x1p-20;
/// The moves of a triangle's corners are halved if it turns by more or shrinks to less than this,
/// up to k_halvings times, and then dropped.
constexpr double k_least_cosine = 0.85;
constexpr double k_least_area = 0.3;
constexpr int k_halvings = 4;

/// How a point pulls its nearest triangle. Floats suffice: the distances are as large as the error
/// of the result.
struct Pull {
  std::uint32_t triangle = 0;
  std::array<float, 2> shares{};  // of the first two corners
  std::array<float, 3> way{};     // of length 1
  float distance = 0;
  float weight = 0;  // 0: no pull

  std::array<double, 3> all_shares() const {
    const auto a = static_cast<double>(shares[0]);
    const auto b = static_cast<double>(shares[1]);
    return {a, b, std::max(0.0, 1 - a - b)};
  }
  Vec3 direction() const {
    return {static_cast<double>(way[0]), static_cast<double>(way[1]), static_cast<double>(way[2])};
  }
};

/// A symmetric 3 x 3 matrix and a right-hand side.
struct System {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 side;

  void add(Vec3 way, double weight) {
    xx += weight * way.x * way.x;
    xy += weight * way.x * way.y;
    xz += weight * way.x * way.z;
    yy += weight * way.y * way.y;
    yz += weight * way.y * way.z;
    zz += weight * way.z * way.z;
  }
  /// Cramer's rule; the matrix is positive definite.
  Vec3 solved() const {
    const Vec3 a = {xx, xy, xz};
    const Vec3 b = {xy, yy, yz};
    const Vec3 c = {xz, yz, zz};
    const Vec3 bc = cross(b, c);
    return (bc * side.x + cross(c, a) * side.y + cross(a, b) * side.z) * (1 / dot(a, bc));
  }
};

class Fitter {
 public:
  Fitter(Mesh& mesh, const VertexFitOptions& options)
      : mesh_(mesh), options_(options), stays_(mesh.positions.size(), 0) {
    std::fill_n(stays_.begin(), std::min<std::size_t>(options.locked_vertices, stays_.size()), 1);
    hold_shared_places();
    const bool has_lines = options.keeps_borders || options.crease_angle > 0;
    if (has_lines || !mesh.columns.labels.empty()) hold_lines();
  }

  std::uint64_t run(std::span<const SurfaceSamples> points) {
    find_pulls(points);
    if (!(weight_ > 0)) return 0;
    moves_.resize(mesh_.positions.size());
    sum_up();
    for (int sweep = 0; sweep < k_sweeps; ++sweep) pull();
    return apply();
  }

 private:
  Vec3 at(std::uint32_t v) const { return mesh_.positions[v]; }

  /// Otherwise touching surfaces would come apart.
  void hold_shared_places() {
    struct Hash {
      std::size_t operator()(const PlaceKey& key) const { return hash_of(key); }
    };
    std::unordered_map<PlaceKey, std::uint32_t, Hash> first;
    first.reserve(mesh_.positions.size());
    for (std::uint32_t v = 0; v < stays_.size(); ++v) {
      const auto [found, is_new] = first.try_emplace(PlaceKey(at(v)), v);
      if (!is_new) stays_[v] = stays_[found->second] = 1;
    }
  }

  /// The ends of borders and creases, and corners of labels.
  void hold_lines() {
    struct Side {
      std::uint32_t low, high, triangle;
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& corners = mesh_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
        sides.push_back({low, high, t});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    std::vector<std::uint8_t> label_lines(stays_.size(), 0);  // that end at a vertex
    std::vector<std::uint8_t> at_border(stays_.size(), 0);
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i + 1;
      while (end < sides.size() && sides[end].low == sides[i].low &&
             sides[end].high == sides[i].high) {
        ++end;
      }
      const auto& [low, high, triangle] = sides[i];
      const bool is_border = end - i == 1;
      if (is_border) at_border[low] = at_border[high] = 1;
      if (!is_border && is_label_line(triangle, sides[i + 1].triangle)) {
        for (const std::uint32_t v : {low, high}) {
          label_lines[v] = static_cast<std::uint8_t>(std::min(label_lines[v] + 1, 3));
        }
      }
      const bool is_held = is_border
                               ? options_.keeps_borders
                               : options_.crease_angle > 0 &&
                                     (end - i > 2 || is_crease(triangle, sides[i + 1].triangle));
      if (is_held) stays_[low] = stays_[high] = 1;
      i = end;
    }
    for (std::size_t v = 0; v < stays_.size(); ++v) {
      if (label_lines[v] == 0) continue;
      if (label_lines[v] != 2 || at_border[v] != 0) stays_[v] = 1;
    }
  }

  bool is_label_line(std::uint32_t a, std::uint32_t b) const {
    const std::vector<Label>& labels = mesh_.columns.labels;
    return !labels.empty() && labels[a] != labels[b];
  }

  bool is_crease(std::uint32_t a, std::uint32_t b) const {
    const Vec3 first = normal_of(mesh_, a);
    const Vec3 second = normal_of(mesh_, b);
    const double most = std::cos(options_.crease_angle * std::numbers::pi / 180);
    return dot(first, second) < most * length(first) * length(second);
  }

  void find_pulls(std::span<const SurfaceSamples> points) {
    const DistanceMeter meter(mesh_, options_.threads);
    for (const SurfaceSamples& set : points) {
      const double weight =
          set.area / static_cast<double>(std::max<std::size_t>(1, set.points.size()));
      const std::vector<std::uint32_t> nearest = meter.nearest_triangles(set.points);
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        const Pull pull = pull_of(set.points[i], nearest[i], weight);
        if (pull.weight > 0) pulls_.push_back(pull);
        weight_ += static_cast<double>(pull.weight);
      }
    }
  }

  Pull pull_of(Vec3 point, std::uint32_t triangle, double weight) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Vec3 normal = normal_of(mesh_, triangle);
    const double twice_area = length(normal);
    if (!(twice_area > 0)) return {};
    const std::array<double, 3> shares = nearest_shares(point, at(a), at(b), at(c));
    const Vec3 off = point - (at(a) * shares[0] + at(b) * shares[1] + at(c) * shares[2]);
    double distance = length(off);
    // Points farther away than the triangle's width belong to something that is gone: a piece or a
    // handle.
    if (distance * distance > twice_area) return {};
    // Where the surface is exact, almost nothing should move.
    if (distance * distance < k_exact * k_exact * twice_area) distance = 0;
    Vec3 way = normal * (1 / twice_area);
    double along = distance > 0 ? dot(off, way) : 0;
    const bool is_inside = std::min({shares[0], shares[1], shares[2]}) > 0;
    if (!is_inside && std::min({a, b, c}) < options_.locked_vertices) return {};
    if (!is_inside && distance > 0) {
      way = off * (1 / distance);
      along = distance;
    }
    return {triangle,
            {static_cast<float>(shares[0]), static_cast<float>(shares[1])},
            {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)},
            static_cast<float>(along),
            static_cast<float>(weight)};
  }

  /// A corner's share in a point replaces its squared share: with this additional weight on the
  /// diagonal, each sweep is sure to come nearer.
  void sum_up() {
    systems_.resize(mesh_.positions.size());
    for (const Pull& each : pulls_) {
      const std::array<double, 3> shares = each.all_shares();
      for (std::size_t k = 0; k < 3; ++k) {
        systems_[mesh_.triangles[each.triangle][k]].add(
            each.direction(), shares[k] * static_cast<double>(each.weight));
      }
    }
    hold_ = k_points_that_hold * weight_ / static_cast<double>(pulls_.size());
    for (System& each : systems_) {
      const double hold = hold_of(each);
      each.xx += hold;
      each.yy += hold;
      each.zz += hold;
    }
  }

  double hold_of(const System& system) const {
    return hold_ + k_slow_down * (system.xx + system.yy + system.zz);
  }

  void pull() {
    for (System& each : systems_) each.side = {};
    for (const Pull& each : pulls_) {
      const Triangle& corners = mesh_.triangles[each.triangle];
      const std::array<double, 3> shares = each.all_shares();
      const Vec3 way = each.direction();
      auto left = static_cast<double>(each.distance);
      for (std::size_t k = 0; k < 3; ++k) left -= shares[k] * dot(way, moves_[corners[k]]);
      const double weight = left * static_cast<double>(each.weight);
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3& side = systems_[corners[k]].side;
        side = side + way * (shares[k] * weight);
      }
    }
    for (std::size_t v = 0; v < moves_.size(); ++v) {
      if (stays_[v] != 0) continue;
      System& system = systems_[v];
      system.side = system.side - moves_[v] * hold_;
      moves_[v] = moves_[v] + system.solved();
    }
  }

  /// Applies the moves: each as a whole or halved as often as its triangles need it.
  std::uint64_t apply() {
    std::vector<Vec3> moved(mesh_.positions.size());
    std::vector<double> share(moved.size(), 1);
    const auto place = [&](std::size_t v) {
      moved[v] = share[v] > 0
                     ? rounded(mesh_.positions[v] + moves_[v] * share[v], options_.positions)
                     : mesh_.positions[v];
    };
    for (std::size_t v = 0; v < moved.size(); ++v) {
      if (moves_[v] == Vec3{}) share[v] = 0;
      place(v);
    }
    std::vector<std::uint32_t> less;  // corners that move less
    for (int round = 0;; ++round) {
      less.clear();
      for (const Triangle& t : mesh_.triangles) {
        if (share[t[0]] == 0 && share[t[1]] == 0 && share[t[2]] == 0) continue;
        if (!is_ruined(t, moved)) continue;
        less.insert(less.end(), t.begin(), t.end());
      }
      if (less.empty()) break;
      std::sort(less.begin(), less.end());
      less.erase(std::unique(less.begin(), less.end()), less.end());
      for (const std::uint32_t v : less) {
        share[v] = round < k_halvings ? share[v] / 2 : 0;
        place(v);
      }
    }
    std::uint64_t count = 0;
    for (std::size_t v = 0; v < moved.size(); ++v) count += moved[v] == mesh_.positions[v] ? 0 : 1;
    mesh_.positions = std::move(moved);
    return count;
  }

  bool is_ruined(const Triangle& t, const std::vector<Vec3>& moved) const {
    const Vec3 before = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    const Vec3 after = cross(moved[t[1]] - moved[t[0]], moved[t[2]] - moved[t[0]]);
    const double area = length(before);
    const double area_after = length(after);
    return !(dot(before, after) >= k_least_cosine * area * area_after) ||
           area_after < k_least_area * area;
  }

  Mesh& mesh_;
  const VertexFitOptions& options_;
  std::vector<std::uint8_t> stays_;
  std::vector<Pull> pulls_;
  double weight_ = 0;  // of all of them
  double hold_ = 0;
  std::vector<System> systems_;  // of the vertices
  std::vector<Vec3> moves_;
};

}  // namespace

std::uint64_t fit_vertices(Mesh& mesh, std::span<const SurfaceSamples> points,
                           const VertexFitOptions& options) {
  if (mesh.triangles.empty()) return 0;
  return Fitter(mesh, options).run(points);
}

}  // namespace meshfarm
