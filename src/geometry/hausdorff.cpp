// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/piece_bounder.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_triangles_at_once = 1024;
/// Chunks bounded at the same time know the lower bound of all chunks before. Their number doubles:
/// the farthest point is soon found, and threads should not wait for each other.
constexpr std::uint64_t k_first_chunks = 8;
constexpr std::uint64_t k_most_chunks = 1024;
/// A vertex is near if its distance is below this share of HausdorffOptions::enough.
constexpr double k_near_corner_share = 0.5;

/// Nothing is proven for points closer to the distance than this share of it.
constexpr double k_gap_of_proof = 0x1p-10;

constexpr std::uint32_t k_unused = UINT32_MAX;

std::uint64_t chunks_of_all(std::size_t count) {
  return (count + k_triangles_at_once - 1) / k_triangles_at_once;
}

HausdorffOptions proof_of(double distance, unsigned threads) {
  HausdorffOptions options;
  options.enough = distance;
  options.gap = distance * k_gap_of_proof;
  options.stops_beyond = true;
  options.threads = threads;
  return options;
}

class SurfaceBounder {
 public:
  SurfaceBounder(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                 const TriangleIndex& to, const HausdorffOptions& options)
      : positions_(positions), triangles_(triangles), to_(to), options_(options) {
    Box box;
    for (const Triangle& t : to.mesh().triangles) add(box, to.mesh().positions, t);
    for (const Triangle& t : triangles) add(box, positions, t);
    rounding_ = rounding_of(box);
  }

  DistanceBounds bound() {
    find_near_triangles();
    const std::uint64_t chunks = chunks_of_all(triangles_.size());
    std::uint64_t at_once = k_first_chunks;
    for (std::uint64_t first = 0; first < chunks && !is_beyond(); at_once *= 2) {
      at_once = std::min({at_once, chunks - first, k_most_chunks});
      std::vector<DistanceBounds> found(at_once);
      parallel_for(at_once, options_.threads,
                   [&](std::uint64_t i) { found[i] = bound_chunk(first + i); });
      for (const DistanceBounds& each : found) add(each);
      first += at_once;
    }
    bounds_.upper = std::max(bounds_.upper, bounds_.lower);
    return bounds_;
  }

  /// The triangles whose upper bound exceeds `enough`.
  std::vector<std::uint32_t> find_beyond() {
    find_near_triangles();
    std::vector<std::vector<std::uint32_t>> found(chunks_of_all(triangles_.size()));
    parallel_for(found.size(), options_.threads, [&](std::uint64_t chunk) {
      PieceBounder pieces(to_.mesh(), to_.bvh(), rounding_);
      const std::size_t end = std::min(triangles_.size(), (chunk + 1) * k_triangles_at_once);
      for (std::size_t i = chunk * k_triangles_at_once; i < end; ++i) {
        const double upper = bound_triangle(triangles_[i], options_, pieces).upper;
        if (upper > options_.enough) found[chunk].push_back(static_cast<std::uint32_t>(i));
      }
    });
    std::vector<std::uint32_t> all;
    for (const auto& each : found) all.insert(all.end(), each.begin(), each.end());
    return all;
  }

 private:
  static void add(Box& box, std::span<const Vec3> positions, const Triangle& t) {
    for (const std::uint32_t v : t) box.add(positions[v]);
  }
  void add(const DistanceBounds& other) {
    bounds_.lower = std::max(bounds_.lower, other.lower);
    bounds_.upper = std::max(bounds_.upper, other.upper);
  }
  bool is_beyond() const { return options_.stops_beyond && bounds_.lower > options_.enough; }

  /// For each used vertex. If a vertex is beyond `enough`, so is the surface.
  void find_near_triangles() {
    near_.assign(positions_.size(), k_unused);
    for (const Triangle& t : triangles_) near_[t[0]] = near_[t[1]] = near_[t[2]] = 0;
    const double enough =
        k_near_corner_share * k_near_corner_share * options_.enough * options_.enough;
    std::vector<double> farthest(chunks_of_all(positions_.size()), 0);
    parallel_for(farthest.size(), options_.threads, [&](std::uint64_t chunk) {
      std::uint32_t guess = 0;
      const std::size_t end = std::min(positions_.size(), (chunk + 1) * k_triangles_at_once);
      for (std::size_t v = chunk * k_triangles_at_once; v < end; ++v) {
        if (near_[v] == k_unused) continue;
        const Bvh::Nearest nearest = to_.bvh().nearest(positions_[v], guess, enough);
        near_[v] = guess = nearest.triangle;
        farthest[chunk] = std::max(farthest[chunk], nearest.squared);
      }
    });
    double most = 0;
    for (const double squared : farthest) most = std::max(most, squared);
    if (most > enough) bounds_.lower = std::max(0.0, std::sqrt(most) * (1 - 0x1p-44) - rounding_);
  }

  DistanceBounds bound_chunk(std::uint64_t chunk) const {
    PieceBounder pieces(to_.mesh(), to_.bvh(), rounding_);
    HausdorffOptions options = options_;
    DistanceBounds found = bounds_;
    const std::size_t end = std::min(triangles_.size(), (chunk + 1) * k_triangles_at_once);
    for (std::size_t i = chunk * k_triangles_at_once; i < end; ++i) {
      const double gap = std::max(options_.gap, options_.relative_gap * found.lower);
      options.enough = std::max(options_.enough, found.lower + gap);
      const DistanceBounds each = bound_triangle(triangles_[i], options, pieces);
      found.lower = std::max(found.lower, each.lower);
      found.upper = std::max(found.upper, each.upper);
      if (options_.stops_beyond && found.lower > options_.enough) break;
    }
    return found;
  }

  /// Most triangles are entirely near one triangle of the other mesh, which is then near one of
  /// their corners.
  DistanceBounds bound_triangle(const Triangle& t, const HausdorffOptions& options,
                                PieceBounder& pieces) const {
    const CornerPoints corners = corners_of(positions_, t);
    const Mesh& to = to_.mesh();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t near = near_[t[i]];
      if (i > 0 && near == near_[t[i - 1]]) continue;
      const double upper = farthest_corner(corners, corners_of(to.positions, to.triangles[near]),
                                           options.stops_beyond ? options.enough : HUGE_VAL) *
                               (1 + 0x1p-44) +
                           rounding_;
      if (upper <= options.enough) return {0, upper};
    }
    std::uint32_t guess = near_[t[0]];
    return pieces.bound(corners, options, guess);
  }

  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  const TriangleIndex& to_;
  HausdorffOptions options_;
  double rounding_ = 0;
  std::vector<std::uint32_t> near_;  // a triangle near each vertex
  DistanceBounds bounds_;
};

}  // namespace

DistanceBounds bound_distance(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                              const TriangleIndex& to, const HausdorffOptions& options) {
  if (triangles.empty()) return {};
  return SurfaceBounder(positions, triangles, to, options).bound();
}

DistanceBounds bound_distance(const Mesh& from, const Mesh& to, const HausdorffOptions& options) {
  if (from.triangles.empty()) return {};
  if (to.triangles.empty()) return {HUGE_VAL, HUGE_VAL};
  const TriangleIndex index(to, options.threads);
  return bound_distance(from.positions, from.triangles, index, options);
}

std::vector<std::uint32_t> find_beyond(std::span<const Vec3> positions,
                                       std::span<const Triangle> triangles, const TriangleIndex& to,
                                       double distance, unsigned threads) {
  return SurfaceBounder(positions, triangles, to, proof_of(distance, threads)).find_beyond();
}

bool is_within(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads) {
  const HausdorffOptions options = proof_of(distance, threads);
  return bound_distance(from.positions, from.triangles, to, options).upper <= distance;
}

void drop_coincident_corners(Mesh& mesh) {
  keep_triangles(mesh, [&](std::size_t i) {
    const auto [a, b, c] = corners_of(mesh.positions, mesh.triangles[i]);
    return a != b && b != c && c != a;
  });
}

}  // namespace meshfarm
