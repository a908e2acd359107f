// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Whether two corners are one vertex, in any numbering.
template <typename Index>
bool is_degenerate(const std::array<Index, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Whether the corners are on one line, or two of them coincide: then it is no part of a surface.
inline bool has_no_area(std::span<const Vec3> positions, const Triangle& t) {
  const Vec3 at = positions[t[0]];
  return cross(positions[t[1]] - at, positions[t[2]] - at) == Vec3{};
}

/// How positions are stored in files. Coordinates are double in memory; a float32 mesh keeps every
/// coordinate exactly representable as float, so that writing it loses nothing.
enum class PositionType : std::uint8_t { float32 = 4, float64 = 8 };

/// What a surface looks like at a vertex, as far as simplification is to keep it: up to four
/// numbers that are interpolated over the triangles, each from 0 to 65535 over the whole range of
/// its channel.
using Appearance = std::array<std::uint16_t, 4>;

/// What a triangle belongs to: a material or a region. While a mesh is simplified, labels are only
/// compared for equality.
using Label = std::uint32_t;

/// A place on a picture, in units of its width and height from its lower left corner. May be
/// outside the picture.
using Uv = std::array<float, 2>;
/// The texture coordinates of a triangle's three corners.
using CornerUvs = std::array<Uv, 3>;

/// Which columns triangles have besides their corners.
struct ColumnSet {
  bool labels = false;
  bool uvs = false;

  constexpr bool any() const { return labels || uvs; }
  ColumnSet and_in(const ColumnSet& other) const {
    return {labels && other.labels, uvs && other.uvs};
  }
  /// Bytes per triangle.
  constexpr std::size_t bytes() const {
    return (labels ? sizeof(Label) : 0) + (uvs ? sizeof(CornerUvs) : 0);
  }
  friend bool operator==(const ColumnSet&, const ColumnSet&) = default;
};

/// The columns of some triangles: each has one entry per triangle, or is empty.
struct TriangleColumnsView {
  std::span<const Label> labels;
  std::span<const CornerUvs> uvs;

  bool empty() const { return labels.empty() && uvs.empty(); }
  ColumnSet set() const { return {!labels.empty(), !uvs.empty()}; }
  /// Whether these are the set's columns, each with one entry for each of `triangles`.
  bool fits(const ColumnSet& columns, std::size_t triangles) const {
    return labels.size() == (columns.labels ? triangles : 0) &&
           uvs.size() == (columns.uvs ? triangles : 0);
  }
  TriangleColumnsView part(std::size_t first, std::size_t count = std::dynamic_extent) const {
    return {labels.empty() ? labels : labels.subspan(first, count),
            uvs.empty() ? uvs : uvs.subspan(first, count)};
  }
};

/// The same, but owning its data. Whatever moves triangles must move these with them.
struct TriangleColumns {
  std::vector<Label> labels;
  std::vector<CornerUvs> uvs;

  bool empty() const { return labels.empty() && uvs.empty(); }
  ColumnSet set() const { return {!labels.empty(), !uvs.empty()}; }
  operator TriangleColumnsView() const { return {labels, uvs}; }
  void append(const TriangleColumnsView& more) {
    labels.insert(labels.end(), more.labels.begin(), more.labels.end());
    uvs.insert(uvs.end(), more.uvs.begin(), more.uvs.end());
  }
  /// Appends the columns of one triangle.
  void append(const TriangleColumnsView& from, std::size_t triangle) {
    if (!from.labels.empty()) labels.push_back(from.labels[triangle]);
    if (!from.uvs.empty()) uvs.push_back(from.uvs[triangle]);
  }
  void move(std::size_t from, std::size_t to) {
    if (!labels.empty()) labels[to] = labels[from];
    if (!uvs.empty()) uvs[to] = uvs[from];
  }
  /// Leaves empty columns empty.
  void resize(std::size_t triangles) {
    if (!labels.empty()) labels.resize(triangles);
    if (!uvs.empty()) uvs.resize(triangles);
  }
  /// Drops the columns that are not in the set.
  void keep(const ColumnSet& set) {
    if (!set.labels) labels = {};
    if (!set.uvs) uvs = {};
  }
  void clear() {
    labels.clear();
    uvs.clear();
  }
};

/// A triangle mesh in memory. Local indices are 32-bit: a mesh in memory is a part or a result.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Appearance> appearances = {};  // one per vertex, or none
  TriangleColumns columns = {};              // of the triangles
};

/// Keeps the triangles, with their columns, for which keep(index) is true; it is called once per
/// triangle, in order. Returns the number of triangles removed.
template <typename AnyTriangle, typename Keep>
std::size_t keep_triangles(std::vector<AnyTriangle>& triangles, TriangleColumns& columns,
                           const Keep& keep) {
  std::size_t kept = 0;
  const std::size_t all = triangles.size();
  for (std::size_t i = 0; i < all; ++i) {
    if (!keep(i)) continue;
    triangles[kept] = triangles[i];
    columns.move(i, kept);
    ++kept;
  }
  triangles.resize(kept);
  columns.resize(kept);
  return all - kept;
}
template <typename Keep>
std::size_t keep_triangles(Mesh& mesh, const Keep& keep) {
  return keep_triangles(mesh.triangles, mesh.columns, keep);
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

/// Marks a vertex without a position: one of its coordinates was not finite.
inline constexpr Vec3 k_no_position{NAN, NAN, NAN};
inline bool has_position(Vec3 p) {
  return p.x == p.x;
}

/// The nearest number that a float can hold. Goes through memory, because g++ 12 drops the rounding
/// of two neighbours when it packs them into a vector ((double)(float)x at -O2).
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

  /// Ignores coordinates that are NaN. (Not std::fmin, which is a call.)
  void add(Vec3 p) {
    lo = {p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z};
    hi = {p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z};
  }
  bool empty() const { return lo.x > hi.x; }
  bool contains(Vec3 p) const {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
  }
  double diagonal() const { return empty() ? 0.0 : length(hi - lo); }
};

}  // namespace meshfarm
