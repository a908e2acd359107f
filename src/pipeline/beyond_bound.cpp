// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/beyond_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <unordered_map>
#include <utility>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/geometry/vertices.hpp>

namespace meshfarm {
namespace {

/// Copies these triangles with their vertices.
Mesh picked(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            const std::vector<std::uint32_t>& numbers) {
  Mesh part;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t i : numbers) append_triangle(positions, triangles[i], number, part);
  return part;
}

/// Adds equal pieces of a triangle: enough that none is longer than `longest`, but at most 32 along
/// a side.
void add_pieces(Vec3 a, Vec3 b, Vec3 c, double longest, Mesh& pieces) {
  constexpr double k_most_steps = 32;
  const double side =
      std::sqrt(std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)}));
  const double steps = std::clamp(std::ceil(side / longest), 1.0, k_most_steps);
  const Vec3 down = (b - a) * (1 / steps);
  const Vec3 along = (c - b) * (1 / steps);
  const auto rows = static_cast<std::uint32_t>(steps);
  auto row = static_cast<std::uint32_t>(pieces.positions.size());
  pieces.positions.push_back(a);
  for (std::uint32_t i = 1; i <= rows; ++i) {
    const std::uint32_t next = row + i;
    for (std::uint32_t j = 0; j <= i; ++j) pieces.positions.push_back(a + down * i + along * j);
    for (std::uint32_t j = 0; j < i; ++j) {
      pieces.triangles.push_back({row + j, next + j, next + j + 1});
      if (j + 1 < i) pieces.triangles.push_back({row + j, next + j + 1, row + j + 1});
    }
    row = next;
  }
}

}  // namespace

TrianglePlaces places_of(const Mesh& mesh, const Triangle& t) {
  TrianglePlaces places{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 p = mesh.positions[t[i]];
    places[i] = {p.x, p.y, p.z};
  }
  std::sort(places.begin(), places.end());
  return places;
}

Mesh part_beyond(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads) {
  std::vector<Triangle> surface;
  std::copy_if(from.triangles.begin(), from.triangles.end(), std::back_inserter(surface),
               [&](const Triangle& t) { return !has_no_area(from.positions, t); });
  return picked(from.positions, surface,
                find_beyond(from.positions, surface, to, distance, threads));
}

AstrayFinder::AstrayFinder(const TriangleIndex& surface, double distance, unsigned threads)
    : surface_(surface), distance_(distance), threads_(threads) {}

void AstrayFinder::pass_over(const Mesh& known) {
  for (const Triangle& t : known.triangles) known_.push_back(places_of(known, t));
  std::sort(known_.begin(), known_.end());
}

Mesh AstrayFinder::find(const Mesh& result) {
  std::vector<TrianglePlaces> near;
  Mesh fresh;
  fresh.positions = result.positions;
  for (const Triangle& t : result.triangles) {
    const TrianglePlaces places = places_of(result, t);
    if (std::binary_search(known_.begin(), known_.end(), places)) continue;
    near.push_back(places);
    if (!std::binary_search(near_.begin(), near_.end(), places)) fresh.triangles.push_back(t);
  }
  const Mesh beyond = part_beyond(fresh, surface_, distance_, threads_);
  std::vector<TrianglePlaces> far;
  for (const Triangle& t : beyond.triangles) far.push_back(places_of(beyond, t));
  std::sort(far.begin(), far.end());
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](const TrianglePlaces& each) {
                              return std::binary_search(far.begin(), far.end(), each);
                            }),
             near.end());
  std::sort(near.begin(), near.end());
  near_ = std::move(near);
  return far_pieces(beyond);
}

/// Processes some triangles at a time, as each may have many pieces.
Mesh AstrayFinder::far_pieces(const Mesh& beyond) const {
  constexpr double k_longest = 0.5;  // in multiples of the distance
  constexpr std::size_t k_at_once = 1000;
  Mesh all;
  for (std::size_t first = 0; first < beyond.triangles.size(); first += k_at_once) {
    Mesh pieces;
    const std::size_t end = std::min(beyond.triangles.size(), first + k_at_once);
    for (std::size_t i = first; i < end; ++i) {
      const auto& [a, b, c] = beyond.triangles[i];
      add_pieces(beyond.positions[a], beyond.positions[b], beyond.positions[c],
                 k_longest * distance_, pieces);
    }
    const Mesh far =
        picked(pieces.positions, pieces.triangles,
               find_beyond(pieces.positions, pieces.triangles, surface_, distance_, threads_));
    append_surface(far.positions, far.triangles, all);
  }
  return all;
}

void clear_near(const Mesh& surface, double distance, const std::vector<Vec3>& positions,
                std::vector<std::uint8_t>& flags) {
  if (surface.triangles.empty()) return;
  const NearCells near(surface.positions, surface.triangles, distance);
  std::vector<std::uint32_t> candidates;
  std::vector<Vec3> points;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    if (!near.touch({positions[v], positions[v]})) continue;
    candidates.push_back(v);
    points.push_back(positions[v]);
  }
  const std::vector<float> distances = distances_to(TriangleIndex(surface, 1), points, 1);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (distances[i] <= distance) flags[candidates[i]] = 0;
  }
}

void clear_touched(const Mesh& surface, double distance, const Mesh& mesh,
                   std::vector<std::uint8_t>& flags) {
  if (surface.triangles.empty()) return;
  const NearCells near(surface.positions, surface.triangles, distance);
  for (const std::uint32_t i : near.touching(mesh.positions, mesh.triangles)) {
    for (const std::uint32_t v : mesh.triangles[i]) flags[v] = 0;
  }
}

}  // namespace meshfarm
