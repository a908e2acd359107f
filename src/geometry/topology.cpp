// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

/// Values sorted into buckets by one counting sort: 8 bytes per bucket, no second copy of the
/// values.
template <typename Value>
class Buckets {
 public:
  explicit Buckets(std::size_t buckets) : ends_(buckets + 1, 0) {}
  void count(std::size_t bucket) { ++ends_[bucket + 1]; }
  void counted() {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    values_.resize(ends_.back());
  }
  // Moves the bucket's begin to its end: after the last put, ends_[b] is where bucket b ends.
  void put(std::size_t bucket, Value value) { values_[ends_[bucket]++] = value; }
  /// The values of one bucket, once all are put.
  std::span<Value> operator[](std::size_t bucket) {
    const std::uint64_t begin = bucket == 0 ? 0 : ends_[bucket - 1];
    return std::span(values_).subspan(begin, ends_[bucket] - begin);
  }

 private:
  std::vector<std::uint64_t> ends_;
  std::vector<Value> values_;
};

/// Most buckets hold a handful of values.
template <typename Value>
void sort_few(std::span<Value> values) {
  if (values.size() > 24) return std::sort(values.begin(), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Value value = values[i];
    std::size_t at = i;
    for (; at > 0 && value < values[at - 1]; --at) values[at] = values[at - 1];
    values[at] = value;
  }
}

std::size_t run_length(std::span<const std::uint32_t> values, std::size_t from,
                       std::uint32_t value) {
  std::size_t at = from;
  while (at < values.size() && values[at] == value) ++at;
  return at - from;
}

/// The edges from one vertex to higher ones. `up`: for each triangle that traverses the edge
/// upwards, the other vertex; `down`: downwards.
void count_edges_at(std::span<const std::uint32_t> up, std::span<const std::uint32_t> down,
                    Topology& topology) {
  std::size_t u = 0, d = 0;
  while (u < up.size() || d < down.size()) {
    const bool next_is_up = d == down.size() || (u < up.size() && up[u] < down[d]);
    const std::uint32_t other = next_is_up ? up[u] : down[d];
    const std::size_t ups = run_length(up, u, other), downs = run_length(down, d, other);
    u += ups;
    d += downs;
    ++topology.edges;
    topology.border_edges += ups + downs == 1;
    topology.nonmanifold_edges += ups + downs > 2;
    topology.unmatched_edges += ups != downs;
    topology.orientation_conflicts += (ups > 1 ? ups - 1 : 0) + (downs > 1 ? downs - 1 : 0);
  }
}

template <typename Visit>
void for_proper_triangles(const Mesh& mesh, const Visit& visit) {
  for (const Triangle& t : mesh.triangles) {
    if (!is_degenerate(t)) visit(t);
  }
}

using Sides = std::span<const std::array<std::uint32_t, 2>>;

void count_edges(const Mesh& mesh, Sides sides, Topology& topology) {
  // Two buckets per vertex: the directed edges up from it and those down to it.
  Buckets<std::uint32_t> edges(2 * mesh.positions.size());
  const auto for_edges = [&](const auto& visit) {
    const auto visit_side = [&](std::uint32_t a, std::uint32_t b) {
      a < b ? visit(std::size_t{a} * 2, b) : visit(std::size_t{b} * 2 + 1, a);
    };
    for_proper_triangles(mesh, [&](const Triangle& t) {
      for (std::size_t k = 0; k < 3; ++k) visit_side(t[k], t[k == 2 ? 0 : k + 1]);
    });
    for (const auto& [a, b] : sides) visit_side(a, b);
  };
  for_edges([&](std::size_t bucket, std::uint32_t) { edges.count(bucket); });
  edges.counted();
  for_edges([&](std::size_t bucket, std::uint32_t other) { edges.put(bucket, other); });
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto up = edges[2 * v], down = edges[2 * v + 1];
    sort_few(up);
    sort_few(down);
    count_edges_at(up, down, topology);
  }
}

void count_duplicates(const Mesh& mesh, Topology& topology) {
  Buckets<std::uint64_t> others(mesh.positions.size());
  for_proper_triangles(mesh, [&](const Triangle& t) {
    others.count(std::min({t[0], t[1], t[2]}));
  });
  others.counted();
  for_proper_triangles(mesh, [&](Triangle t) {
    std::sort(t.begin(), t.end());
    others.put(t[0], std::uint64_t{t[1]} << 32 | t[2]);
  });
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto values = others[v];
    sort_few(values);
    for (std::size_t i = 1; i < values.size(); ++i) {
      topology.duplicate += values[i] == values[i - 1];
    }
  }
}

std::vector<std::uint32_t> count_components(const Mesh& mesh, std::span<const std::uint32_t> shared,
                                            Topology& topology) {
  UnionFind pieces(mesh.positions.size());
  std::vector<bool> used(mesh.positions.size());
  std::uint64_t joined = 0;
  for_proper_triangles(mesh, [&](const Triangle& t) {
    for (const std::uint32_t v : t) used[v] = true;
    joined += pieces.join(t[0], t[1]);
    joined += pieces.join(t[1], t[2]);
  });
  for (const std::uint32_t v : shared) used[v] = true;
  topology.used_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
  topology.components = topology.used_vertices - joined;
  std::vector<std::uint32_t> roots;
  for (const std::uint32_t v : shared) roots.push_back(pieces.find(v));
  return roots;
}

void check_indices(const Mesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= mesh.positions.size()) {
      throw DataError("a triangle names vertex " + std::to_string(std::max({t[0], t[1], t[2]})) +
                      " of a mesh of " + std::to_string(mesh.positions.size()) + " vertices");
    }
  }
}

}  // namespace

Topology measure_topology(const Mesh& mesh) {
  return measure_piece(mesh, {}, {}).topology;
}

PieceTopology measure_piece(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> sides,
                            std::span<const std::uint32_t> shared) {
  check_indices(mesh);
  PieceTopology piece;
  Topology& topology = piece.topology;
  topology.vertices = mesh.positions.size();
  topology.triangles = mesh.triangles.size();
  for (const Triangle& t : mesh.triangles) {
    if (is_degenerate(t))
      ++topology.degenerate;
    else
      topology.zero_area += has_no_area(mesh.positions, t);
  }
  piece.roots = count_components(mesh, shared, topology);
  count_edges(mesh, sides, topology);
  count_duplicates(mesh, topology);
  topology.euler = static_cast<std::int64_t>(topology.used_vertices - topology.edges +
                                             topology.triangles - topology.degenerate);
  return piece;
}

}  // namespace meshfarm
