// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/sheet_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/place_cells.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_twin = UINT32_MAX;

// Sample size to tell whether a search is worthwhile: a third of these triangles must have twins.
constexpr std::size_t k_looked_at_first = 64;

}  // namespace

/// Finds twins, and which of two sheets stands for both.
class SheetPairing {
 public:
  SheetPairing(const Mesh& mesh, std::span<const std::uint8_t> flags, double reach)
      : mesh_(mesh), number_(mesh.positions.size(), k_no_twin) {
    const double area = find_normals();
    std::vector<Vec3> thin;
    for (std::uint32_t v = 0; v < flags.size(); ++v) {
      if ((flags[v] & k_thin) == 0 || !is_finite(mesh.positions[v])) continue;
      number_[v] = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(v);
      thin.push_back(mesh.positions[v]);
    }
    const auto vertices = static_cast<double>(std::max<std::size_t>(1, mesh.positions.size()));
    places_.emplace(std::move(thin), reach, std::sqrt(area / vertices));
    adjacency_.build(mesh.triangles, mesh.positions.size());
  }

  /// False if too few triangles have twins.
  bool run() {
    if (!is_promising()) return false;
    std::vector<std::uint32_t> nearest(mesh_.positions.size(), k_no_twin);
    for (const std::uint32_t v : vertices_) nearest[v] = twin_of(v);
    twins_.assign(nearest.size(), k_no_twin);
    for (const std::uint32_t v : vertices_) {
      if (nearest[v] != k_no_twin && nearest[nearest[v]] == v) twins_[v] = nearest[v];
    }
    sort_triangles();
    const auto leading = std::count(sides_.begin(), sides_.end(), Side::leads);
    return 4 * static_cast<std::size_t>(leading) > mesh_.triangles.size();
  }

  /// After run(). False if too many vertices were to be held.
  bool write(SheetPairs& pairs) {
    list_held(pairs.wall_.locked);
    const std::uint64_t locked = pairs.wall_.locked;
    if (held_.size() > locked + std::max(locked, pairs.wall_.most_held_up)) return false;
    write_vertices(pairs);
    Mesh& single = pairs.single_;
    const bool is_all = std::find(sides_.begin(), sides_.end(), Side::alone) == sides_.end();
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (sides_[i] == Side::follows) continue;
      const Triangle& t = mesh_.triangles[i];
      single.triangles.push_back({number_[t[0]], number_[t[1]], number_[t[2]]});
      if (is_all) continue;
      single.columns.labels.push_back(sides_[i] == Side::leads ? SheetPairs::k_paired : 0);
    }
    return true;
  }

 private:
  enum class Side : std::uint8_t { alone, leads, follows };

  /// Returns the area.
  double find_normals() {
    double area = 0;
    normals_.resize(mesh_.positions.size());
    for (const auto& [a, b, c] : mesh_.triangles) {
      const Vec3 p = mesh_.positions[a];
      const Vec3 normal = cross(mesh_.positions[b] - p, mesh_.positions[c] - p);
      for (const std::uint32_t v : {a, b, c}) normals_[v] = normals_[v] + normal;
      const double twice = length(normal);
      if (std::isfinite(twice)) area += 0.5 * twice;
    }
    return area;
  }

  bool do_face_apart(std::uint32_t a, std::uint32_t b) const {
    constexpr double k_cos_60_squared = 0.25;
    const double along = dot(normals_[a], normals_[b]);
    return along < 0 && along * along > k_cos_60_squared * squared_length(normals_[a]) *
                                            squared_length(normals_[b]);
  }

  /// The nearest vertex that faces the other way.
  std::uint32_t twin_of(std::uint32_t vertex) const {
    if (number_[vertex] == k_no_twin) return k_no_twin;
    const auto twin = places_->nearest(mesh_.positions[vertex], [&](std::uint32_t point) {
      return do_face_apart(vertex, vertices_[point]);
    });
    return twin ? vertices_[*twin] : k_no_twin;
  }

  /// Whether the twins of a triangle's corners form a triangle that faces back.
  bool has_triangle(const Triangle& twins) const {
    if (std::find(twins.begin(), twins.end(), k_no_twin) != twins.end()) return false;
    const std::span<const Corner> fan = adjacency_.at(twins[0]);
    return std::find(fan.begin(), fan.end(), Corner{twins[2], twins[1]}) != fan.end();
  }

  bool is_promising() const {
    const std::size_t triangles = mesh_.triangles.size();
    const std::size_t step = triangles / k_looked_at_first + 1;
    std::size_t looked_at = 0, found = 0;
    for (std::size_t i = 0; i < triangles; i += step, ++looked_at) {
      const auto& [a, b, c] = mesh_.triangles[i];
      found += has_triangle({twin_of(a), twin_of(b), twin_of(c)}) ? 1 : 0;
    }
    return 3 * found > looked_at;
  }

  /// Connected triangles with twins are a sheet, except one that is its own mirror image.
  void sort_triangles() {
    UnionFind sheets(mesh_.positions.size());
    sides_.assign(mesh_.triangles.size(), Side::alone);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const auto& [a, b, c] = mesh_.triangles[i];
      if (!has_triangle({twins_[a], twins_[b], twins_[c]})) continue;
      sides_[i] = Side::leads;
      sheets.join(a, b);
      sheets.join(a, c);
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (sides_[i] == Side::alone) continue;
      const std::uint32_t a = mesh_.triangles[i][0];
      const auto own = sheets.find(a);
      const auto other = sheets.find(twins_[a]);
      if (own == other) sides_[i] = Side::alone;
      if (own > other) sides_[i] = Side::follows;
    }
  }

  /// The locked vertices, and those where a sheet ends or is locked, with their twins.
  void list_held(std::uint32_t locked) {
    leads_.assign(mesh_.positions.size(), 0);
    std::vector<std::uint8_t> stays(leads_.size(), 0);
    std::fill_n(stays.begin(), locked, std::uint8_t{1});
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (const std::uint32_t v : mesh_.triangles[i]) {
        if (sides_[i] == Side::alone) stays[v] = 1;
        if (sides_[i] == Side::leads) leads_[v] = 1;
      }
    }
    // In a part, the twins of unpaired vertices may be in other parts, where they stay unchanged.
    std::vector<std::uint8_t> holds(leads_.size(), 0);
    if (locked > 0) holds = stays;
    for (std::uint32_t v = 0; v < leads_.size(); ++v) {
      if (leads_[v] == 0 || (stays[v] | stays[twins_[v]]) == 0) continue;
      holds[v] = holds[twins_[v]] = 1;
    }
    held_.clear();
    used_ = std::move(stays);
    for (std::uint32_t v = 0; v < holds.size(); ++v) {
      if (holds[v] != 0) held_.push_back(v);
      used_[v] |= leads_[v];
    }
    for (const std::uint32_t v : held_) used_[v] = 0;
  }

  void write_vertices(SheetPairs& pairs) {
    std::vector<Vec3>& positions = pairs.single_.positions;
    const auto add = [&](std::uint32_t v) {
      number_[v] = static_cast<std::uint32_t>(positions.size());
      positions.push_back(mesh_.positions[v]);
    };
    for (const std::uint32_t v : held_) add(v);
    for (std::uint32_t v = 0; v < used_.size(); ++v) {
      if (used_[v] != 0) add(v);
    }
    for (const std::uint32_t v : held_) {
      pairs.twins_.push_back(leads_[v] != 0 ? number_[twins_[v]] : k_no_twin);
    }
    std::vector<Vec3> places;
    for (std::uint32_t v = 0; v < leads_.size(); ++v) {
      if (leads_[v] == 0) continue;
      places.push_back(mesh_.positions[v]);
      pairs.ways_.push_back(mesh_.positions[twins_[v]] - mesh_.positions[v]);
    }
    pairs.places_.emplace(std::move(places));
  }

  const Mesh& mesh_;
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> vertices_;  // that are thin
  std::vector<std::uint32_t> number_;    // in vertices_, later in the single mesh
  std::optional<PlaceCells> places_;     // of vertices_
  Adjacency adjacency_;
  std::vector<std::uint32_t> twins_;  // of each vertex, or none
  std::vector<Side> sides_;           // of each triangle
  std::vector<std::uint8_t> leads_;   // vertices of leading triangles
  std::vector<std::uint8_t> used_;    // vertices of the single mesh that are not held
  std::vector<std::uint32_t> held_;
};

std::optional<SheetPairs> SheetPairs::find(const Mesh& mesh, std::span<const std::uint8_t> flags,
                                           const Wall& wall) {
  const auto thin = static_cast<std::size_t>(std::count_if(
      flags.begin(), flags.end(), [](std::uint8_t each) { return (each & k_thin) != 0; }));
  if (2 * thin < mesh.positions.size()) return std::nullopt;
  SheetPairing pairing(mesh, flags, wall.reach);
  SheetPairs pairs(wall);
  if (!pairing.run() || !pairing.write(pairs)) return std::nullopt;
  return pairs;
}

std::uint64_t SheetPairs::triangles_of(const Mesh& single) const {
  const std::vector<Label>& labels = single.columns.labels;
  const std::size_t pairs =
      labels.empty() ? single.triangles.size()
                     : static_cast<std::size_t>(std::count(labels.begin(), labels.end(), k_paired));
  return single.triangles.size() + pairs;
}

Mesh SheetPairs::both(const Mesh& single) const {
  std::vector<Vec3> positions = single.positions;
  std::vector<Triangle> triangles = single.triangles;
  std::vector<std::uint32_t> twins = twins_;
  twins.resize(single.positions.size(), k_no_twin);
  for (std::size_t i = 0; i < single.triangles.size(); ++i) {
    if (!has_twin(single, i)) continue;
    const Triangle& t = single.triangles[i];
    for (const std::uint32_t v : t) {
      if (twins[v] != k_no_twin) continue;
      twins[v] = static_cast<std::uint32_t>(positions.size());
      std::uint32_t nearest = 0;
      places_->nearest(positions[v], {&nearest, 1});
      positions.push_back(rounded(positions[v] + ways_[nearest], wall_.positions));
    }
    triangles.push_back({twins[t[0]], twins[t[2]], twins[t[1]]});
  }
  std::vector<std::uint32_t> number(positions.size(), k_no_twin);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) number[v] = 0;
  }
  std::fill_n(number.begin(), wall_.locked, 0);
  Mesh both;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (number[v] == k_no_twin) continue;
    number[v] = static_cast<std::uint32_t>(both.positions.size());
    both.positions.push_back(positions[v]);
  }
  for (Triangle& t : triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  both.triangles = std::move(triangles);
  return both;
}

}  // namespace meshfarm
