// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_finish.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_map>
#include <utility>
#include <vector>

#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

namespace meshfarm {
namespace {

/// So many triangles from a seam on the parts are as simple as they may be.
constexpr int k_rings = 5;
/// In distances of the bound: what is farther from a surface matters to nothing that is made of it.
constexpr double k_reach = 2;

/// And those of no triangle, which are to go.
std::vector<std::uint8_t> vertices_round(const Mesh& mesh, std::vector<std::uint8_t> near) {
  std::vector<std::uint8_t> flags;
  for (int ring = 0; ring < k_rings; ++ring) {
    flags = near;
    for (const auto& [a, b, c] : mesh.triangles) {
      if ((flags[a] | flags[b] | flags[c]) != 0) near[a] = near[b] = near[c] = 1;
    }
  }
  flags.assign(near.size(), 0);  // now: of a triangle
  for (const auto& [a, b, c] : mesh.triangles) flags[a] = flags[b] = flags[c] = 1;
  for (std::size_t v = 0; v < near.size(); ++v) {
    if (flags[v] == 0) near[v] = 1;
  }
  return near;
}

/// Renumbers the vertices: those that are flagged come last, the order kept otherwise. Returns how
/// many are not.
std::uint32_t put_last(Mesh& mesh, const std::vector<std::uint8_t>& flags) {
  std::vector<std::uint32_t> number(flags.size());
  std::uint32_t next = 0;
  std::uint32_t first = 0;
  for (const std::uint8_t wanted : {std::uint8_t{0}, std::uint8_t{1}}) {
    for (std::uint32_t v = 0; v < flags.size(); ++v) {
      if (flags[v] == wanted) number[v] = next++;
    }
    if (wanted == 0) first = next;
  }
  Mesh ordered;
  place_vertices(VertexView(mesh), number, next, ordered);
  ordered.triangles = std::move(mesh.triangles);
  ordered.columns = std::move(mesh.columns);
  renumber_corners(ordered.triangles, number);
  mesh = std::move(ordered);
  return first;
}

/// Adds the triangles of a piece that are near, each with vertices of its own piece.
void add_near(const SurfacePiece& piece, const NearCells& near, Mesh& mesh) {
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (const Triangle& t : piece.triangles) {
    Box box;
    for (const std::uint32_t v : t) box.add(piece.positions[v]);
    if (!near.touch(box)) continue;
    Triangle& added = mesh.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, is_new] =
          number.try_emplace(t[i], static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(piece.positions[t[i]]);
      added[i] = at->second;
    }
  }
}

/// Pieces of a part come in order, parts in any.
Mesh input_near(const Stage& stage, const Manifest& manifest, const NearCells& near,
                unsigned threads) {
  std::vector<Mesh> of_part(manifest.parts.size() + 1);
  InputSurface input(stage, manifest, threads);
  input.show([&](const Box& box) { return near.touch(box); },
             [&](const SurfacePiece& piece) { add_near(piece, near, of_part[piece.part]); });
  Mesh all;
  for (Mesh& mesh : of_part) {
    append_surface(mesh.positions, mesh.triangles, all);
    mesh = {};
  }
  return all;
}

}  // namespace

BoundedFinish finish_to_bound(const Stage& stage, const Manifest& manifest, StitchedMesh stitched,
                              const BoundedFinishOptions& options) {
  Mesh mesh = std::move(stitched.mesh);
  std::vector<std::uint8_t> flags = std::move(stitched.seam);
  if (std::find(flags.begin(), flags.end(), 1) == flags.end()) return {std::move(mesh)};
  flags = vertices_round(mesh, std::move(flags));
  const std::uint32_t locked = put_last(mesh, flags);
  std::vector<Triangle> round;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(round),
               [&](const Triangle& t) { return *std::max_element(t.begin(), t.end()) >= locked; });
  const NearCells near(mesh.positions, round, k_reach * options.max_error);
  Mesh input = input_near(stage, manifest, near, options.threads);
  if (input.triangles.empty()) return {std::move(mesh)};
  const SurfaceBound bound(std::move(input), {options.max_error, options.threads, true});
  Simplifier simplifier(std::move(mesh), {.locked_vertices = locked,
                                          .positions = manifest.positions,
                                          .lines = options.lines,
                                          .bound = &bound});
  simplifier.reduce({}, [&](std::uint64_t left) {
    options.progress(left);
    return true;
  });
  return {simplifier.mesh(), simplifier.dropped_degenerate(), simplifier.dropped_duplicate(),
          simplifier.turned()};
}

}  // namespace meshfarm
