// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/working_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>

#include "geometry/simplify/simplify_queue.hpp"
#include "geometry/simplify/thin_walls.hpp"

namespace meshfarm {
namespace {

// Walls thinner than this share of the final edge length are thin. From 0.1 to 0.35, the number of
// crossing triangles on scans is the same.
constexpr double k_thin_share = 0.15;
// Squared edge length per area of an equilateral triangle.
constexpr double k_edge_of_area = 2.31;
// The maximum reduction assumed, as nobody knows the final one.
constexpr double k_most_at_once = 64;

bool has_three_corners(const Triangle& t) {
  const auto [a, b, c] = t;
  return (a != b) & (b != c) & (c != a);
}

}  // namespace

WorkingMesh::WorkingMesh(Mesh mesh, const SimplifyOptions& options)
    : mesh_(std::move(mesh)),
      locked_(options.locked_vertices),
      type_(options.positions),
      seam_only_(!options.seam.empty()),
      avoids_crossings_(options.lines.crossings == CrossingMode::avoid),
      appearance_scale_(options.lines.appearance_scale),
      uv_scale_(options.lines.uv_scale),
      creases_(options.lines.crease_angle,
               options.lines.columns.and_in(mesh_.columns.set()).any()) {
  check_input(mesh_, options);
  if (!(appearance_scale_.length > 0)) mesh_.appearances = {};
  mesh_.columns.keep(options.lines.columns);
  Surface surface = clean_surface(mesh_, options, adjacency_);
  dropped_ = surface.dropped;
  flags_ = std::move(surface.flags);
  for (const std::uint32_t v : options.opened) flags_[v] |= k_opened;
  creases_.find(mesh_, adjacency_, flags_);
  drop_unused_vertices();
  if (avoids_crossings_ && !seam_only_ && options.bound == nullptr) pieces_.find(mesh_, flags_);
}

std::uint64_t WorkingMesh::free_triangles() const {
  const auto is_free = [&](const Triangle& t) {
    return t[0] >= locked_ && t[1] >= locked_ && t[2] >= locked_;
  };
  return static_cast<std::uint64_t>(
      std::count_if(mesh_.triangles.begin(), mesh_.triangles.end(), is_free));
}

bool WorkingMesh::is_above(const SimplifyGoal& goal) const {
  const std::uint64_t now = mesh_.triangles.size();
  if (now != goal.triangles + 1) return now > goal.triangles;
  return last_of(goal) >= goal.triangles && std::any_of(flags_.begin(), flags_.end(), may_lose_one);
}

bool WorkingMesh::has_free_border() const {
  return std::any_of(flags_.begin(), flags_.end(),
                     [](std::uint8_t flags) { return (flags & (k_border | k_fixed)) == k_border; });
}

std::vector<std::uint32_t> WorkingMesh::opened() const {
  std::vector<std::uint32_t> opened;
  for (std::uint32_t v = 0; v < flags_.size(); ++v) {
    if ((flags_[v] & k_opened) != 0) opened.push_back(v);
  }
  return opened;
}

std::vector<std::uint8_t> WorkingMesh::seam() const {
  std::vector<std::uint8_t> seam;
  if (!seam_only_) return seam;
  seam.resize(flags_.size());
  std::transform(flags_.begin(), flags_.end(), seam.begin(), [](std::uint8_t flags) {
    return static_cast<std::uint8_t>((flags & k_seam) != 0 ? 1 : 0);
  });
  return seam;
}

double WorkingMesh::flag_thin_walls(std::uint64_t last, double bound) {
  if (!avoids_crossings_) return 0;
  double area = 0;
  for (const Triangle& t : mesh_.triangles) {
    const Vec3 p = mesh_.positions[t[0]];
    const double twice = length(cross(mesh_.positions[t[1]] - p, mesh_.positions[t[2]] - p));
    if (std::isfinite(twice)) area += 0.5 * twice;
  }
  const double left =
      std::max({1.0, static_cast<double>(last), static_cast<double>(triangles()) / k_most_at_once});
  const double edge = std::sqrt(k_edge_of_area * area / left);
  const double reach = bound > 0 ? 2 * bound : k_thin_share * edge;
  meshfarm::flag_thin_walls(mesh_, reach, flags_);
  return reach;
}

void WorkingMesh::begin_pass() {
  if (!adjacency_is_current_) {
    adjacency_.build(mesh_.triangles, mesh_.positions.size(), mesh_.columns);
  }
  creases_.update(mesh_, adjacency_, flags_);
  const std::size_t vertices = mesh_.positions.size();
  target_.resize(vertices);
  std::iota(target_.begin(), target_.end(), 0U);
  touched_.assign(vertices, 0);
}

CollapseState WorkingMesh::state() {
  return {mesh_.positions,
          flags_,
          target_,
          &adjacency_,
          type_,
          &creases_.test(),
          mesh_.appearances,
          appearance_scale_,
          uv_scale_,
          {},
          !avoids_crossings_};
}

void WorkingMesh::merge(std::uint32_t a, std::uint32_t b, const Collapse& collapse,
                        const MergedColumns& columns) {
  if (!columns.wedges.empty()) {
    merge_wedges(columns.wedges, adjacency_.fan_at(a).ids, adjacency_.fan_at(b).ids,
                 mesh_.columns.uvs);
  }
  touched_[a] = touched_[b] = 1;
  target_[b] = a;
  flags_[a] |= flags_[b];
  mesh_.positions[a] = collapse.position;
  if (!mesh_.appearances.empty()) mesh_.appearances[a] = columns.appearance;
  max_cost_ = std::max(max_cost_, collapse.cost);
}

void WorkingMesh::end_pass(std::uint64_t removed, double cost) {
  pass_cost_ = cost;
  adjacency_is_current_ = removed == 0;
  if (removed > 0) compact();
}

/// Renumbers the vertices that are left, in their order, and drops the triangles that are gone. All
/// are moved: a branch on which ones stay would be mispredicted half of the time.
void WorkingMesh::compact() {
  compact_appearances();
  pieces_.compact(target_);
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    // A vertex merges into a smaller one, whose new number is known by now.
    const std::uint32_t target = target_[v];
    const bool stays = target == v;
    mesh_.positions[kept] = mesh_.positions[v];
    flags_[kept] = flags_[v];
    target_[v] = stays ? kept : target_[target];
    kept += stays ? 1 : 0;
  }
  mesh_.positions.resize(kept);
  flags_.resize(kept);
  compact_columns();
  std::size_t left = 0;
  for (const Triangle& t : mesh_.triangles) {
    const Triangle now = {target_[t[0]], target_[t[1]], target_[t[2]]};
    mesh_.triangles[left] = now;
    left += has_three_corners(now) ? 1 : 0;
  }
  mesh_.triangles.resize(left);
}

/// Separate, so that meshes without appearances do not even ask. Must run while the targets are old
/// numbers.
void WorkingMesh::compact_appearances() {
  if (mesh_.appearances.empty()) return;
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    mesh_.appearances[kept] = mesh_.appearances[v];
    kept += target_[v] == v ? 1 : 0;
  }
  mesh_.appearances.resize(kept);
}

/// The same for columns. Must run while the targets are new numbers and the triangles' corners old
/// ones.
void WorkingMesh::compact_columns() {
  if (mesh_.columns.empty()) return;
  std::size_t left = 0;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Triangle& t = mesh_.triangles[i];
    mesh_.columns.move(i, left);
    left += has_three_corners({target_[t[0]], target_[t[1]], target_[t[2]]}) ? 1 : 0;
  }
  mesh_.columns.resize(left);
}

void WorkingMesh::move_vertex(std::uint32_t from, std::uint32_t to) {
  put_vertex(VertexView(mesh_), from, mesh_, to);
  flags_[to] = flags_[from];
}

/// Keeps the first `count` vertices.
void WorkingMesh::keep_vertices(std::uint32_t count) {
  resize_vertices(mesh_, count);
  flags_.resize(count);
}

void WorkingMesh::drop_unused_vertices() {
  target_.resize(mesh_.positions.size());
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    if (v >= locked_ && adjacency_.count(v) == 0) continue;
    move_vertex(v, kept);
    target_[v] = kept++;
  }
  adjacency_is_current_ = kept == target_.size();
  keep_vertices(kept);
  for (Triangle& t : mesh_.triangles) t = {target_[t[0]], target_[t[1]], target_[t[2]]};
}

void WorkingMesh::restore_pieces() {
  for (const auto& [vertices, places] : pieces_.restored(mesh_.triangles, mesh_.positions, type_)) {
    for (std::size_t i = 0; i < vertices.size(); ++i) mesh_.positions[vertices[i]] = places[i];
  }
}

void WorkingMesh::take(const CollapseQueue& queue) {
  queue.copy_to(mesh_, flags_, locked_);
  pieces_.clear();
  adjacency_is_current_ = false;
  max_cost_ = std::max(max_cost_, queue.max_cost());
  pass_cost_ = std::max(pass_cost_, queue.last_cost());
}

}  // namespace meshfarm
