// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/part_builder.hpp"

#include <algorithm>
#include <numeric>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/geometry/weld.hpp>

#include "divide/weld_share.hpp"

namespace meshfarm {
namespace {

/// Replaces each corner by its representative; drops triangles that become degenerate.
std::uint64_t merge_corners(Mesh& mesh, const std::vector<std::uint32_t>& representative) {
  bool any_lost = false;
  for (Triangle& t : mesh.triangles) {
    const auto [a, b, c] = t = {representative[t[0]], representative[t[1]], representative[t[2]]};
    any_lost |= (a == b) | (b == c) | (c == a);
  }
  if (!any_lost) return 0;
  return keep_triangles(mesh, [&](std::size_t i) {
    const auto [a, b, c] = mesh.triangles[i];
    return a != b && b != c && c != a;
  });
}

/// Numbers the used representatives: boundary first, each group in raw order. Returns the number of
/// boundary vertices.
std::uint32_t number_vertices(const std::vector<Triangle>& triangles,
                              const std::vector<std::uint32_t>& boundary_raw,
                              const std::vector<std::uint32_t>& representative,
                              std::vector<std::uint32_t>& number) {
  constexpr std::uint32_t k_inner = 0;
  constexpr std::uint32_t k_boundary = 1;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t corner : t) number[corner] = k_inner;
  }
  for (const std::uint32_t raw : boundary_raw) number[representative[raw]] = k_boundary;
  const auto boundary =
      static_cast<std::uint32_t>(std::count(number.begin(), number.end(), k_boundary));
  std::uint32_t next_boundary = 0;
  std::uint32_t next_inner = boundary;
  for (std::uint32_t& n : number) {
    if (n != k_left_out) n = n == k_boundary ? next_boundary++ : next_inner++;
  }
  return boundary;
}

}  // namespace

BuiltPart build_part(MeshShare raw, Weld weld_mode) {
  BuiltPart built;
  std::vector<std::uint32_t> representative;
  std::vector<std::uint32_t> point;  // like representative, before any were taken apart
  if (weld_mode == Weld::exact) {
    WeldResult welded = weld(raw.positions);
    if (!raw.apart.empty()) point = welded.first;
    static_cast<WeldCounts&>(built) = keep_apart(raw, welded);
    representative = std::move(welded.first);
  } else {
    representative.resize(raw.positions.size());
    std::iota(representative.begin(), representative.end(), 0U);
  }
  Mesh& mesh = built.part.mesh;
  mesh.triangles = std::move(raw.triangles);
  mesh.columns = std::move(raw.columns);
  built.dropped_degenerate = merge_corners(mesh, representative);
  // If nothing was welded, only the dropped triangles are known.
  built.coincident_corners = std::max(built.coincident_corners, built.dropped_degenerate);

  built.boundary.places = boundary_places(std::move(raw.boundary));

  std::vector<std::uint32_t> number(raw.positions.size(), k_left_out);
  Part& part = built.part;
  part.positions = raw.type;
  part.boundary_vertices =
      number_vertices(mesh.triangles, built.boundary.places, representative, number);
  const auto used = number.size() -
                    static_cast<std::size_t>(std::count(number.begin(), number.end(), k_left_out));
  // Of merged vertices the least appearance counts, whatever their order.
  for (std::size_t i = 0; i < raw.appearances.size(); ++i) {
    Appearance& of_one = raw.appearances[representative[i]];
    of_one = std::min(of_one, raw.appearances[i]);
  }
  place_vertices({raw.positions, raw.appearances}, number, used, mesh);
  renumber_corners(mesh.triangles, number);
  built.boundary.numbers.reserve(built.boundary.places.size());
  for (const std::uint32_t b : built.boundary.places) {
    built.boundary.numbers.push_back(number[representative[b]]);
    if (!point.empty()) built.boundary.points.push_back(point[b]);
  }
  return built;
}

}  // namespace meshfarm
