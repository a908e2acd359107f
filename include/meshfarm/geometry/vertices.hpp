// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

// Whatever moves vertices between meshes, or within one, must move all their data. Only these
// functions name the vertex columns one by one.

/// The new number of a vertex that is left out when vertices are renumbered.
inline constexpr std::uint32_t k_left_out = std::numeric_limits<std::uint32_t>::max();

/// `appearances`: whether the mesh has them.
inline void resize_vertices(Mesh& mesh, std::size_t count, bool appearances) {
  mesh.positions.resize(count);
  mesh.appearances.resize(appearances ? count : 0);
}
/// Keeps the columns that the mesh has.
inline void resize_vertices(Mesh& mesh, std::size_t count) {
  resize_vertices(mesh, count, !mesh.appearances.empty());
}

inline void clear_vertices(Mesh& mesh) {
  resize_vertices(mesh, 0, false);
}

/// Overwrites the existing vertex `at` with a vertex of `from`, which may view the same mesh.
inline void put_vertex(const VertexView& from, std::size_t vertex, Mesh& to, std::size_t at) {
  to.positions[at] = from.positions[vertex];
  if (!from.appearances.empty()) to.appearances[at] = from.appearances[vertex];
}

/// `from` may view the same mesh.
inline void append_vertex(const VertexView& from, std::size_t vertex, Mesh& to) {
  to.positions.push_back(from.positions[vertex]);
  if (!from.appearances.empty()) to.appearances.push_back(from.appearances[vertex]);
}

/// Appends all vertices. If only one of the two has appearances, the other's become 0.
inline void append_vertices(const VertexView& from, Mesh& to) {
  const std::size_t first = to.positions.size();
  const bool appearances = !from.appearances.empty() || !to.appearances.empty();
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  if (!appearances) return;
  to.appearances.resize(first);
  to.appearances.insert(to.appearances.end(), from.appearances.begin(), from.appearances.end());
  to.appearances.resize(to.positions.size());
}

/// Replaces the vertices of `to` by those of `from`: v becomes number[v], which are 0 to count - 1
/// in any order, or k_left_out.
inline void place_vertices(const VertexView& from, std::span<const std::uint32_t> number,
                           std::size_t count, Mesh& to) {
  resize_vertices(to, count, !from.appearances.empty());
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] != k_left_out) put_vertex(from, v, to, number[v]);
  }
}

/// Appends a surface: positions and triangles.
inline void append_surface(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           Mesh& to) {
  const auto first = static_cast<std::uint32_t>(to.positions.size());
  append_vertices(VertexView(positions), to);
  for (const auto& [a, b, c] : triangles) {
    to.triangles.push_back({a + first, b + first, c + first});
  }
}

/// Appends a triangle, and those of its vertices that are not there yet. `number`: the new numbers
/// of those that are.
inline void append_triangle(std::span<const Vec3> positions, const Triangle& triangle,
                            std::unordered_map<std::uint32_t, std::uint32_t>& number, Mesh& to) {
  Triangle& added = to.triangles.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [at, is_new] =
        number.try_emplace(triangle[i], static_cast<std::uint32_t>(to.positions.size()));
    if (is_new) to.positions.push_back(positions[triangle[i]]);
    added[i] = at->second;
  }
}

/// Gives the corners of triangles the new numbers of their vertices.
template <typename Triangles>
void renumber_corners(Triangles& triangles, std::span<const std::uint32_t> number) {
  for (auto& t : triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
}

}  // namespace meshfarm
