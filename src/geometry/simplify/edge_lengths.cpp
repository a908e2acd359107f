// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_vertices_a_block = 4096;  // fixed, so that sums are, too

/// A side of a triangle, seen from the lower of its vertices.
struct TurnedSide {
  std::uint32_t other = 0;
  std::uint32_t triangle = 0;
  friend bool operator<(const TurnedSide& a, const TurnedSide& b) {
    return std::tie(a.other, a.triangle) < std::tie(b.other, b.triangle);
  }
};

class EdgeMeter {
 public:
  explicit EdgeMeter(const Mesh& mesh) : mesh_(mesh), ends_(mesh.positions.size() + 1) {
    WeldResult welded = weld(mesh.positions);
    separate_touching(mesh.triangles, {}, welded);
    vertices_ = std::move(welded.first);
    for_sides([&](std::uint32_t from, TurnedSide) { ++ends_[from + 1]; });
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    sides_.resize(ends_.back());
    // Advances the begin of each vertex to its end.
    for_sides([&](std::uint32_t from, TurnedSide side) { sides_[ends_[from]++] = side; });
  }

  EdgeLengths measure(unsigned threads) {
    const std::size_t vertices = mesh_.positions.size();
    std::vector<EdgeLengths> blocks((vertices + k_vertices_a_block - 1) / k_vertices_a_block);
    parallel_for(blocks.size(), threads, [&](std::uint64_t block) {
      const std::size_t end = std::min(vertices, (block + 1) * k_vertices_a_block);
      for (std::size_t v = block * k_vertices_a_block; v < end; ++v) add_edges(v, blocks[block]);
    });
    EdgeLengths all;
    for (const EdgeLengths& block : blocks) {
      all.border += block.border;
      all.feature += block.feature;
    }
    return all;
  }

 private:
  Triangle welded(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }

  template <typename Take>
  void for_sides(const Take& take) const {
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle t = welded(i);
      if (is_degenerate(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
        take(low, {high, i});
      }
    }
  }

  void add_edges(std::size_t vertex, EdgeLengths& lengths) {
    const std::size_t begin = vertex == 0 ? 0 : ends_[vertex - 1];
    const std::span<TurnedSide> sides = std::span(sides_).subspan(begin, ends_[vertex] - begin);
    std::sort(sides.begin(), sides.end());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      while (last < sides.size() && sides[last].other == sides[first].other) ++last;
      const Vec3 from = mesh_.positions[vertex], to = mesh_.positions[sides[first].other];
      if (last - first == 1) lengths.border += length(to - from);
      if (last - first == 2 && is_feature(vertex, sides[first], sides[first + 1])) {
        lengths.feature += length(to - from);
      }
    }
  }

  bool is_feature(std::size_t vertex, const TurnedSide& a, const TurnedSide& b) const {
    const Vec3 of_a = normal_seen_from(vertex, a), of_b = normal_seen_from(vertex, b);
    // Where both triangles face the same side, one of the two is seen from behind.
    static const double k_cosine = std::cos(k_feature_degrees * std::acos(-1.0) / 180);
    const double both = length(of_a) * length(of_b);
    return both > 0 && -dot(of_a, of_b) < k_cosine * both;
  }

  /// The normal as if the triangle went from the vertex to the other vertex of the side.
  Vec3 normal_seen_from(std::size_t vertex, const TurnedSide& side) const {
    const Triangle t = welded(side.triangle);
    const Vec3 a = mesh_.positions[t[0]];
    const Vec3 normal = cross(mesh_.positions[t[1]] - a, mesh_.positions[t[2]] - a);
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == vertex && t[(k + 1) % 3] == side.other) return normal;
    }
    return normal * -1;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> vertices_;  // the vertex that each is after welding
  std::vector<std::uint64_t> ends_;      // the end of each vertex's sides in sides_
  std::vector<TurnedSide> sides_;
};

}  // namespace

EdgeLengths measure_edge_lengths(const Mesh& mesh, unsigned threads) {
  return EdgeMeter(mesh).measure(threads);
}

}  // namespace meshfarm
