// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// How positions are kept in files. Coordinates are double in memory; a float32 mesh keeps every
/// coordinate exactly representable as float, so that writing it loses nothing.
enum class PositionType : std::uint8_t { float32 = 4, float64 = 8 };

/// What a surface looks like at a vertex, as far as simplification is to keep it: up to four
/// numbers that are blended over the triangles, each from 0 to 65535 over the whole range of its
/// channel.
using Appearance = std::array<std::uint16_t, 4>;

/// What a triangle belongs to, a material or a region. Only whether two are the same counts while a
/// mesh is simplified.
using Label = std::uint32_t;

/// A triangle mesh in memory. Local indices are 32-bit: a mesh in memory is a part or a result.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Appearance> appearances = {};  // one a vertex, or none at all
  std::vector<Label> labels = {};            // one a triangle, or none at all
};

/// Keeps the triangles, with their labels if there are any, for whose index keep(index) is true;
/// each is asked for once, in order. Returns how many have gone.
template <typename Keep>
std::size_t keep_triangles(std::vector<Triangle>& triangles, std::vector<Label>& labels,
                           const Keep& keep) {
  std::size_t kept = 0;
  const std::size_t all = triangles.size();
  for (std::size_t i = 0; i < all; ++i) {
    if (!keep(i)) continue;
    triangles[kept] = triangles[i];
    if (!labels.empty()) labels[kept] = labels[i];
    ++kept;
  }
  triangles.resize(kept);
  if (!labels.empty()) labels.resize(kept);
  return all - kept;
}
template <typename Keep>
std::size_t keep_triangles(Mesh& mesh, const Keep& keep) {
  return keep_triangles(mesh.triangles, mesh.labels, keep);
}

/// Vertices of some mesh, and their appearances if it has any.
struct VertexView {
  VertexView() = default;
  VertexView(std::span<const Vec3> of_positions, std::span<const Appearance> of_appearances = {})
      : positions(of_positions), appearances(of_appearances) {}
  VertexView(const std::vector<Vec3>& of_positions) : positions(of_positions) {}
  explicit VertexView(const Mesh& mesh)
      : positions(mesh.positions), appearances(mesh.appearances) {}

  std::size_t size() const { return positions.size(); }
  VertexView part(std::size_t first, std::size_t count = std::dynamic_extent) const {
    return {positions.subspan(first, count),
            appearances.empty() ? appearances : appearances.subspan(first, count)};
  }

  std::span<const Vec3> positions;
  std::span<const Appearance> appearances;
};

inline void append_vertex(const VertexView& from, std::size_t vertex, Mesh& to) {
  to.positions.push_back(from.positions[vertex]);
  if (!from.appearances.empty()) to.appearances.push_back(from.appearances[vertex]);
}

/// Stands for a vertex without a position: one of its coordinates was not finite.
inline constexpr Vec3 k_no_position{NAN, NAN, NAN};
inline bool has_position(Vec3 p) {
  return p.x == p.x;
}

/// The nearest number that a float can hold. Through memory, as g++ 12 drops the rounding of two
/// neighbours when it packs them into a vector ((double)(float)x at -O2).
inline double rounded_to_float(double x) {
  const volatile auto narrow = static_cast<float>(x);
  return static_cast<double>(narrow);
}

/// The nearest point that `type` can hold.
inline Vec3 rounded(Vec3 p, PositionType type) {
  if (type == PositionType::float64) return p;
  return {rounded_to_float(p.x), rounded_to_float(p.y), rounded_to_float(p.z)};
}

/// An axis-aligned box. Empty (lo > hi) until a point is added.
struct Box {
  Vec3 lo{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3 hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  /// A coordinate that is not a number adds nothing. (Not std::fmin, which is a call.)
  void add(Vec3 p) {
    lo = {p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z};
    hi = {p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z};
  }
  bool empty() const { return lo.x > hi.x; }
  double diagonal() const { return empty() ? 0.0 : length(hi - lo); }
};

}  // namespace meshfarm
