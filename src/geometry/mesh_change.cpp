// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/mesh_change.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/bvh_morton.hpp"
#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {

ChangingMesh::ChangingMesh(Mesh& mesh) : mesh_(mesh) {
  list_fans();
  build_boxes();
}

void ChangingMesh::list_fans() {
  first_.assign(mesh_.positions.size() + 1, 0);
  for (const Triangle& t : mesh_.triangles) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  fans_.resize(3 * mesh_.triangles.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh_.triangles[i]) fans_[next[v]++] = i;
  }
}

/// Slots are sorted by the triangles' first corners along a curve.
void ChangingMesh::build_boxes() {
  Box all;
  for (const Vec3& p : mesh_.positions) all.add(p);
  BoxTree::Frame frame{all.lo * 0.5 + all.hi * 0.5, 1};
  const double size = all.diagonal();
  if (size > 0 && std::isfinite(size)) frame.scale = std::ldexp(1.0, -std::ilogb(size) - 1);
  const auto corner_of = [&](std::uint32_t i) { return mesh_.positions[mesh_.triangles[i][0]]; };
  std::vector<MortonItem> items(mesh_.triangles.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    items[i] = {morton_code((corner_of(i) - frame.center) * frame.scale), i};
  }
  sort_along_curve(items, corner_of);
  slot_of_.resize(items.size());
  triangle_in_.resize(items.size());
  std::vector<Box> boxes(items.size());
  for (std::uint32_t slot = 0; slot < items.size(); ++slot) {
    const std::uint32_t triangle = items[slot].number;
    triangle_in_[slot] = triangle;
    slot_of_[triangle] = slot;
    for (const Vec3& p : corners_of(triangle)) boxes[slot].add(p);
  }
  boxes_.build(frame, boxes);
}

TriangleCorners ChangingMesh::corners_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
}

TriangleCorners ChangingMesh::corners_after(std::uint32_t triangle,
                                            const MeshChange& change) const {
  Triangle t = mesh_.triangles[triangle];
  for (const auto& [which, now] : change.rewired) {
    if (which == triangle) t = now;
  }
  TriangleCorners corners{mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]};
  for (const auto& [vertex, place] : change.moved) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == vertex) corners[k] = place;
    }
  }
  return corners;
}

std::span<const std::uint32_t> ChangingMesh::fan(std::uint32_t vertex) const {
  const auto changed = changed_fans_.find(vertex);
  if (changed != changed_fans_.end()) return changed->second;
  return std::span(fans_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
}

std::optional<std::uint32_t> ChangingMesh::beside(std::uint32_t a, std::uint32_t b) const {
  std::optional<std::uint32_t> found;
  std::size_t count = 0;
  for (const std::uint32_t triangle : fan(a)) {
    const Triangle& t = mesh_.triangles[triangle];
    const std::size_t at = place_of(t, a);
    if (t[(at + 1) % 3] == b) ++count;
    if (t[(at + 2) % 3] != b) continue;
    ++count;
    found = triangle;
  }
  return count == 2 ? found : std::nullopt;
}

bool ChangingMesh::is_inside(std::uint32_t vertex) const {
  const std::span<const std::uint32_t> around = fan(vertex);
  return std::all_of(around.begin(), around.end(), [&](std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    return beside(vertex, t[(place_of(t, vertex) + 1) % 3]).has_value();
  });
}

std::vector<std::uint32_t> ChangingMesh::concerned_by(const MeshChange& change) const {
  std::vector<std::uint32_t> concerned;
  for (const auto& [triangle, now] : change.rewired) concerned.push_back(triangle);
  for (const auto& [vertex, place] : change.moved) {
    const std::span<const std::uint32_t> around = fan(vertex);
    concerned.insert(concerned.end(), around.begin(), around.end());
  }
  std::sort(concerned.begin(), concerned.end());
  concerned.erase(std::unique(concerned.begin(), concerned.end()), concerned.end());
  return concerned;
}

bool ChangingMesh::apply(const MeshChange& change, std::span<const std::uint32_t> concerned) {
  Triangles before, after;
  before.reserve(concerned.size());
  after.reserve(concerned.size());
  for (const std::uint32_t triangle : concerned) {
    before.emplace_back(corners_of(triangle));
    after.emplace_back(corners_after(triangle, change));
  }
  list_others(concerned, before, after);
  const std::size_t crossing = pairs_of(after, SIZE_MAX);
  if (crossing > 0 && pairs_of(before, crossing) < crossing) return false;
  for (const auto& [vertex, place] : change.moved) mesh_.positions[vertex] = place;
  rewire(change);
  for (std::size_t i = 0; i < concerned.size(); ++i) {
    boxes_.set(slot_of_[concerned[i]], after[i].box);
  }
  return true;
}

void ChangingMesh::list_others(std::span<const std::uint32_t> concerned, const Triangles& before,
                               const Triangles& after) {
  Box box;
  for (const Triangles* each : {&before, &after}) {
    for (const CrossingTriangle& t : *each) {
      box.add(t.box.lo);
      box.add(t.box.hi);
    }
  }
  touching_.clear();
  boxes_.find_touching(box, touching_);
  others_.clear();
  for (const std::uint32_t slot : touching_) {
    const std::uint32_t triangle = triangle_in_[slot];
    if (std::binary_search(concerned.begin(), concerned.end(), triangle)) continue;
    others_.emplace_back(corners_of(triangle));
  }
}

/// The pairs of these triangles that cross, with each other and with the others; stops at `enough`.
std::size_t ChangingMesh::pairs_of(const Triangles& some, std::size_t enough) const {
  std::size_t pairs = 0;
  const auto crosses = [&](const CrossingTriangle& a, const CrossingTriangle& b) {
    return do_touch(a.box, b.box) && do_cross(a, b);
  };
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (const CrossingTriangle& other : others_) {
      if (crosses(some[i], other) && ++pairs >= enough) return pairs;
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (crosses(some[i], some[k]) && ++pairs >= enough) return pairs;
    }
  }
  return pairs;
}

void ChangingMesh::rewire(const MeshChange& change) {
  for (const auto& [triangle, now] : change.rewired) {
    const Triangle was = std::exchange(mesh_.triangles[triangle], now);
    for (const std::uint32_t v : was) change_fan(v, triangle);
    for (const std::uint32_t v : now) change_fan(v, triangle);
  }
}

/// Updates the fan after the triangle has left the vertex or joined it.
void ChangingMesh::change_fan(std::uint32_t vertex, std::uint32_t triangle) {
  const std::span<const std::uint32_t> before = fan(vertex);
  std::vector<std::uint32_t> changed(before.begin(), before.end());
  std::erase(changed, triangle);
  if (place_of(mesh_.triangles[triangle], vertex) < 3) changed.push_back(triangle);
  changed_fans_[vertex] = std::move(changed);
}

}  // namespace meshfarm
