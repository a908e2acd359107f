// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/orient.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_side = std::numeric_limits<std::uint32_t>::max();

/// A side of a triangle at its lower vertex: to a higher one, or from it.
struct EdgeSide {
  std::uint32_t high;
  std::uint32_t side;  // 3 x triangle + its first corner
  bool upwards;
};

/// The sides of all triangles, sorted by lower vertex, then higher vertex, then triangle. `starts`
/// has one entry more than there are vertices.
std::vector<EdgeSide> sort_sides(const std::vector<Triangle>& triangles,
                                 std::vector<std::uint32_t>& starts) {
  std::uint32_t highest = 0;
  for (const Triangle& t : triangles) highest = std::max({highest, t[0], t[1], t[2]});
  starts.assign(std::size_t{highest} + 3, 0);
  const auto for_sides = [&](const auto& use) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k)
        use(triangles[t][k], triangles[t][(k + 1) % 3], 3 * t + k);
    }
  };
  // Counted two places up, so that each start is where it belongs when the sides are placed.
  for_sides([&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++starts[std::min(a, b) + 2]; });
  for (std::size_t v = 2; v < starts.size(); ++v) starts[v] += starts[v - 1];
  std::vector<EdgeSide> sides(3 * triangles.size());
  for_sides([&](std::uint32_t a, std::uint32_t b, std::uint32_t side) {
    sides[starts[std::min(a, b) + 1]++] = {std::max(a, b), side, a < b};
  });
  starts.pop_back();
  for (std::size_t v = 0; v + 1 < starts.size(); ++v) {
    std::sort(sides.begin() + starts[v], sides.begin() + starts[v + 1],
              [](const EdgeSide& x, const EdgeSide& y) {
                return x.high != y.high ? x.high < y.high : x.side < y.side;
              });
  }
  return sides;
}

/// The triangle across each side, where it has one: 2 x triangle, plus 1 if it faces the other way.
std::vector<std::uint32_t> find_neighbours(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> starts;
  const std::vector<EdgeSide> sides = sort_sides(triangles, starts);
  std::vector<std::uint32_t> across(sides.size(), k_no_side);
  for (std::size_t v = 0; v + 1 < starts.size(); ++v) {
    for (std::size_t first = starts[v], last = first; first < starts[v + 1]; first = last) {
      const auto [high, side, upwards] = sides[first];
      while (last < starts[v + 1] && sides[last].high == high) ++last;
      if (last - first != 2) continue;
      const EdgeSide& other = sides[first + 1];
      const std::uint32_t turned = upwards == other.upwards ? 1 : 0;
      across[side] = 2 * (other.side / 3) + turned;
      across[other.side] = 2 * (side / 3) + turned;
    }
  }
  return across;
}

double area_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3& p = mesh.positions[a];
  return length(cross(mesh.positions[b] - p, mesh.positions[c] - p)) / 2;
}

/// The part of a piece that faces one way.
struct Half {
  double area = 0;
  std::uint64_t triangles = 0;
};

/// Turns the half of a piece with less area; if equal, the one with fewer triangles; if equal, the
/// one without the first triangle.
std::uint64_t turn_piece(Mesh& mesh, const std::vector<std::uint32_t>& piece,
                         const std::vector<std::uint8_t>& half) {
  std::array<Half, 2> halves;
  for (const std::uint32_t t : piece) {
    halves[half[t]].area += area_of(mesh, t);
    ++halves[half[t]].triangles;
  }
  if (halves[1].triangles == 0) return 0;
  const auto& [first, other] = halves;
  const bool is_known_by_area = first.area < other.area || first.area > other.area;
  const bool is_first_smaller =
      is_known_by_area ? first.area < other.area : first.triangles < other.triangles;
  const std::uint8_t turned = is_first_smaller ? 0 : 1;
  for (const std::uint32_t t : piece) {
    if (half[t] != turned) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (!mesh.columns.uvs.empty()) std::swap(mesh.columns.uvs[t][1], mesh.columns.uvs[t][2]);
  }
  return halves[turned].triangles;
}

}  // namespace

std::uint64_t orient(Mesh& mesh) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::vector<std::uint32_t> across = find_neighbours(triangles);
  constexpr std::uint8_t k_unseen = 2;
  std::vector<std::uint8_t> half(triangles.size(), k_unseen);
  std::vector<std::uint32_t> piece;
  std::uint64_t turned = 0;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (half[first] != k_unseen) continue;
    piece.assign(1, first);
    half[first] = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t next = across[3 * piece[i] + k];
        if (next == k_no_side || half[next / 2] != k_unseen) continue;
        half[next / 2] = static_cast<std::uint8_t>(half[piece[i]] ^ (next & 1));
        piece.push_back(next / 2);
      }
    }
    turned += turn_piece(mesh, piece, half);
  }
  return turned;
}

}  // namespace meshfarm
