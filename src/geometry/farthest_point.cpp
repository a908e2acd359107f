// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/farthest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <meshfarm/util/parallel.hpp>

#include "geometry/piece_bounder.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_corner_chunk = 4096;  // triangles; fixed, so that results are too
constexpr std::size_t k_searched = 200;       // triangles
constexpr int k_first_steps = 10;             // along a side
constexpr int k_next_steps = 5;
constexpr int k_search_rounds = 5;

bool is_farther(const FarPoint& a, const FarPoint& b) {
  return a.distance != b.distance ? a.distance > b.distance : a.triangle < b.triangle;
}

/// Searches for the farthest point of a triangle.
class TriangleSearch {
 public:
  TriangleSearch(const Mesh& from, std::uint32_t triangle, const Bvh& to) : to_(to) {
    for (std::size_t k = 0; k < 3; ++k) corners_[k] = from.positions[from.triangles[triangle][k]];
  }
  double farthest() {
    look_round(0, 0, 1, k_first_steps);
    double side = 2.0 / k_first_steps;
    for (int round = 0; round < k_search_rounds; ++round, side *= 2.0 / k_next_steps) {
      look_round(at_[0] - side / 2, at_[1] - side / 2, side, k_next_steps);
    }
    return std::sqrt(farthest_);
  }

 private:
  /// Tries a grid over a square of shares of the second and third corner, as far as it is on the
  /// triangle.
  void look_round(double first, double second, double side, int steps) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        if (steps == k_first_steps && i + j > steps) break;
        look_at(first + side * i / steps, second + side * j / steps);
      }
    }
  }
  void look_at(double b, double c) {
    b = std::clamp(b, 0.0, 1.0);
    c = std::clamp(c, 0.0, 1.0);
    if (b + c > 1) {  // beyond the third side: move onto it
      b = std::clamp((1 + b - c) / 2, 0.0, 1.0);
      c = 1 - b;
    }
    const Vec3 p = corners_[0] * (1 - b - c) + corners_[1] * b + corners_[2] * c;
    const Bvh::Nearest nearest = to_.nearest(p, guess_);
    guess_ = nearest.triangle;
    if (!(nearest.squared > farthest_)) return;
    farthest_ = nearest.squared;
    at_ = {b, c};
  }

  const Bvh& to_;
  std::array<Vec3, 3> corners_;
  std::array<double, 2> at_{};
  double farthest_ = -1;
  std::uint32_t guess_ = 0;
};

/// The farthest corner of each chunk of triangles, if it is farther than `least`.
std::vector<FarPoint> far_corners(const Mesh& from, const Bvh& to, double least, unsigned threads) {
  const std::size_t count = from.triangles.size();
  std::vector<FarPoint> found((count + k_corner_chunk - 1) / k_corner_chunk);
  parallel_for(found.size(), threads, [&](std::uint64_t chunk) {
    double farthest = least * least;
    std::uint32_t guess = 0;
    const std::size_t end = std::min(count, (chunk + 1) * k_corner_chunk);
    for (std::size_t i = chunk * k_corner_chunk; i < end; ++i) {
      const auto [a, b, c] = corners_of(from.positions, from.triangles[i]);
      if (a == b || b == c || c == a) continue;  // not a surface: a run drops it
      for (const Vec3& corner : {a, b, c}) {
        const Bvh::Nearest nearest = to.nearest(corner, guess, farthest);
        guess = nearest.triangle;
        if (!(nearest.squared > farthest)) continue;
        farthest = nearest.squared;
        found[chunk] = {std::sqrt(farthest), static_cast<std::uint32_t>(i)};
      }
    }
  });
  std::erase_if(found, [](const FarPoint& point) { return !(point.distance > 0); });
  return found;
}

}  // namespace

double find_farthest(const Mesh& from, const Bvh& to, std::span<const FarPoint> known,
                     unsigned threads) {
  std::vector<FarPoint> far(known.begin(), known.end());
  double least = 0;
  for (const FarPoint& point : far) least = std::max(least, point.distance);
  const std::vector<FarPoint> corners = far_corners(from, to, least, threads);
  far.insert(far.end(), corners.begin(), corners.end());
  std::sort(far.begin(), far.end(), is_farther);
  const double farthest_known = far.empty() ? 0 : far.front().distance;
  far.resize(std::min(far.size(), k_searched));
  std::vector<double> found(far.size());
  parallel_for(far.size(), threads, [&](std::uint64_t i) {
    found[i] = TriangleSearch(from, far[i].triangle, to).farthest();
  });
  const auto farthest = std::max_element(found.begin(), found.end());
  return farthest == found.end() ? farthest_known : std::max(farthest_known, *farthest);
}

}  // namespace meshfarm
