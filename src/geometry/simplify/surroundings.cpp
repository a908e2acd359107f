// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/surroundings.hpp"

#include <algorithm>
#include <utility>

namespace meshfarm {

namespace {

/// To make the index anew takes about as long as to pass over so many points for each that it has.
constexpr std::uint64_t k_worth_an_index = 8;

std::uint32_t vertex_now(const ShrinkingMesh& mesh, std::uint32_t v) {
  while (mesh.target[v] != v) v = mesh.target[v];
  return v;
}

}  // namespace

double Surroundings::squared_distance(const ShrinkingMesh& mesh, Vec3 from,
                                      std::span<const std::uint32_t> without) {
  if (!index_) list_vertices(mesh);
  if (passed_over_ > k_worth_an_index * vertices_.size()) drop_what_is_gone(mesh);
  return index_->squared_distance(from, [&](std::uint32_t point) {
    const std::uint32_t v = vertex_now(mesh, vertices_[point]);
    const bool is_left = mesh.adjacency->count(v) > 0;
    passed_over_ += is_left ? 0 : 1;
    return is_left && !std::binary_search(without.begin(), without.end(), v);
  });
}

/// Where most pieces go, a search would pass over more and more points, and find the same.
void Surroundings::drop_what_is_gone(const ShrinkingMesh& mesh) {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> vertices;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t v = vertex_now(mesh, vertices_[i]);
    if (mesh.adjacency->count(v) == 0) continue;
    points.push_back(index_->points()[i]);
    vertices.push_back(v);
  }
  vertices_ = std::move(vertices);
  index_.emplace(std::move(points));
  passed_over_ = 0;
}

void Surroundings::list_vertices(const ShrinkingMesh& mesh) {
  std::vector<Vec3> points;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.target[v] != v || mesh.adjacency->count(v) == 0) continue;
    points.push_back(mesh.positions[v]);
    vertices_.push_back(v);
  }
  index_.emplace(std::move(points));
}

}  // namespace meshfarm
