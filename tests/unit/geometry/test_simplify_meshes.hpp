// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "support/meshes.hpp"

namespace meshfarm::simplify_test {

using test::tetrahedron;

/// An open grid of (columns + 1) x (rows + 1) vertices over the unit square, z = height(x, y).
template <typename Height>
Mesh grid(std::uint32_t columns, std::uint32_t rows, const Height& height) {
  Mesh mesh;
  for (std::uint32_t r = 0; r <= rows; ++r) {
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double x = static_cast<double>(c) / columns;
      const double y = static_cast<double>(r) / rows;
      mesh.positions.push_back({x, y, height(x, y)});
    }
  }
  const std::uint32_t w = columns + 1;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t v = r * w + c;
      mesh.triangles.push_back({v, v + 1, v + w + 1});
      mesh.triangles.push_back({v, v + w + 1, v + w});
    }
  }
  return mesh;
}

inline Mesh flat_grid(std::uint32_t columns, std::uint32_t rows) {
  return grid(columns, rows, [](double, double) { return 0.0; });
}

inline Mesh wavy_grid(std::uint32_t columns, std::uint32_t rows) {
  return grid(columns, rows,
              [](double x, double y) { return 0.05 * std::sin(9 * x) * std::cos(7 * y + x); });
}

/// A torus of outer radius 2 + `thickness`.
inline Mesh ring_of_tube(std::uint32_t around, std::uint32_t across, double thickness) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = turn * i / around;
      const double v = turn * j / across;
      const double r = 2 + thickness * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), thickness * std::sin(v)});
      const std::uint32_t i1 = (i + 1) % around;
      const std::uint32_t j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j;
      const std::uint32_t b = i1 * across + j;
      const std::uint32_t c = i1 * across + j1;
      const std::uint32_t d = i * across + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Radii 2 and 1.
inline Mesh wide_torus(std::uint32_t around, std::uint32_t across) {
  return ring_of_tube(around, across, 1);
}

/// Quarters the triangles `times` times; `place` moves the new vertices.
template <typename PlaceAt>
Mesh quartered(Mesh mesh, int times, const PlaceAt& place) {
  for (int i = 0; i < times; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (added) mesh.positions.push_back(place(mesh.positions[a] + mesh.positions[b]));
      return at->second;
    };
    std::vector<Triangle> quarters;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]);
      const std::uint32_t b = middle(t[1], t[2]);
      const std::uint32_t c = middle(t[2], t[0]);
      quarters.insert(quarters.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(quarters);
  }
  return mesh;
}
inline Mesh quartered(Mesh mesh, int times) {
  return quartered(std::move(mesh), times, [](Vec3 sum) { return sum * 0.5; });
}

/// A sphere of radius 1: an octahedron whose triangles are quartered `times` times.
inline Mesh sphere(int times) {
  Mesh mesh{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  return quartered(std::move(mesh), times, [](Vec3 sum) { return sum * (1 / length(sum)); });
}

inline void append(Mesh& mesh, const Mesh& other, Vec3 shift) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3 p : other.positions) mesh.positions.push_back(p + shift);
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

inline double area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]];
    sum += length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) / 2;
  }
  return sum;
}

/// What must hold for any result, counted with sets and maps; shares no code with the project.
struct Validity {
  std::uint64_t bad_index = 0;
  std::uint64_t degenerate = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t no_area = 0;
  std::uint64_t unused = 0;
  std::uint64_t border_edges = 0;
  std::uint64_t crowded_edges = 0;  // three triangles or more, or one direction twice
  std::uint64_t components = 0;
  std::int64_t euler = 0;
};

inline Validity check(const Mesh& mesh) {
  Validity v;
  std::set<std::set<std::uint32_t>> faces;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;
  std::vector<std::uint32_t> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t x) {
    while (root[x] != x) x = root[x] = root[root[x]];
    return x;
  };
  std::set<std::uint32_t> used;
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= mesh.positions.size()) {
      ++v.bad_index;
      continue;
    }
    const std::set<std::uint32_t> face(t.begin(), t.end());
    if (face.size() < 3) {
      ++v.degenerate;
      continue;
    }
    if (!faces.insert(face).second) ++v.duplicate;
    const Vec3 a = mesh.positions[t[0]];
    if (cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a) == Vec3{}) ++v.no_area;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      auto& both = edges[std::minmax(from, to)];
      ++(from < to ? both.first : both.second);
      used.insert(from);
      root[find(from)] = find(to);
    }
  }
  for (const auto& [edge, both] : edges) {
    v.border_edges += both.first + both.second == 1 ? 1 : 0;
    v.crowded_edges += both.first > 1 || both.second > 1 ? 1 : 0;
  }
  for (const std::uint32_t x : used) v.components += find(x) == x ? 1 : 0;
  v.unused = mesh.positions.size() - used.size();
  v.euler = static_cast<std::int64_t>(used.size()) - static_cast<std::int64_t>(edges.size()) +
            static_cast<std::int64_t>(faces.size());
  return v;
}

/// Whether nothing is broken or unused.
inline bool is_clean(const Mesh& mesh) {
  const Validity v = check(mesh);
  return v.bad_index + v.degenerate + v.duplicate + v.no_area + v.unused + v.crowded_edges == 0;
}

/// A small pseudo-random generator, the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435761U + 88172645463325252U) {}
  std::uint32_t below(std::uint32_t n) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::uint32_t>((state_ >> 33) % n);
  }
  double unit() { return below(1U << 24) / static_cast<double>(1U << 24); }

 private:
  std::uint64_t state_;
};

inline bool same_bytes(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

inline Simplifier reduced_topology(const Mesh& mesh, std::uint64_t triangles,
                                   TopologyMode topology = TopologyMode::automatic) {
  SimplifyOptions options;
  options.lines.topology = topology;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({triangles});
  return simplifier;
}

/// The greater values of both directions.
inline Distance topology_error(const Mesh& original, const Mesh& result) {
  DistanceOptions options;
  options.samples = 50'000;
  options.threads = 1;
  const Distance there = measure_distance(original, result, options);
  const Distance back = measure_distance(result, original, options);
  return {std::max(there.rms, back.rms), std::max(there.mean, back.mean),
          std::max(there.max, back.max)};
}

}  // namespace meshfarm::simplify_test
