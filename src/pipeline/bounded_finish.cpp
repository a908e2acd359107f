// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_finish.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

#include "pipeline/bound_proof.hpp"

namespace meshfarm {
namespace {

/// So many triangles from a seam on the parts are as simple as they may be.
constexpr int k_rings = 5;
/// In distances of the bound: what is farther from a surface matters to nothing that is made of it.
constexpr double k_reach = 2;
/// So often what is not proven is left as it was stitched, before all is.
constexpr int k_attempts = 4;

/// The vertices of no triangle are to go.
void flag_unused(const Mesh& mesh, std::vector<std::uint8_t>& flags) {
  std::vector<std::uint8_t> used(flags.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles) used[a] = used[b] = used[c] = 1;
  for (std::size_t v = 0; v < flags.size(); ++v) {
    if (used[v] == 0) flags[v] = 1;
  }
}

/// And those of no triangle.
std::vector<std::uint8_t> vertices_round(const Mesh& mesh, std::vector<std::uint8_t> near) {
  std::vector<std::uint8_t> flags;
  for (int ring = 0; ring < k_rings; ++ring) {
    flags = near;
    for (const auto& [a, b, c] : mesh.triangles) {
      if ((flags[a] | flags[b] | flags[c]) != 0) near[a] = near[b] = near[c] = 1;
    }
  }
  flag_unused(mesh, near);
  return near;
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

/// A triangle by its places: vertices may be taken apart, or their numbers change.
using Places = std::array<std::array<double, 3>, 3>;

Places places_of(const Mesh& mesh, const Triangle& t) {
  Places places{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 p = mesh.positions[t[i]];
    places[i] = {p.x, p.y, p.z};
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// Those of the first `locked` vertices, in an order of their own.
std::vector<Places> fixed_places(const Mesh& mesh, std::uint32_t locked) {
  std::vector<Places> fixed;
  for (const Triangle& t : mesh.triangles) {
    if (*std::max_element(t.begin(), t.end()) < locked && !is_degenerate(t)) {
      fixed.push_back(places_of(mesh, t));
    }
  }
  std::sort(fixed.begin(), fixed.end());
  return fixed;
}

/// Whether none of them has gone. Tells which of the triangles are others.
bool are_kept(const std::vector<Places>& fixed, const Mesh& mesh, std::vector<Triangle>& others) {
  std::vector<std::uint8_t> is_there(fixed.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const auto [first, last] = std::equal_range(fixed.begin(), fixed.end(), places_of(mesh, t));
    if (first == last) others.push_back(t);
    std::fill(is_there.begin() + (first - fixed.begin()), is_there.begin() + (last - fixed.begin()),
              std::uint8_t{1});
  }
  return std::find(is_there.begin(), is_there.end(), 0) == is_there.end();
}

/// Proves what the finish has made round the seams. What is farther from them was proven before,
/// part by part.
class SeamProof {
 public:
  /// `input`: all of it that is near what may change.
  SeamProof(Mesh input, const BoundedFinishOptions& options)
      : input_(std::move(input)), options_(options) {
    drop_coincident_corners(input_);
    if (!input_.triangles.empty()) index_.emplace(input_, options.threads);
  }

  /// What is not proven of `result`, made of `stitched`, whose first `locked` vertices have not
  /// moved: triangles of either surface.
  Mesh find_unproven(const Mesh& stitched, std::uint32_t locked, const Mesh& result) const {
    std::vector<Triangle> changed;
    if (!index_ || result.triangles.empty() ||
        !are_kept(fixed_places(stitched, locked), result, changed)) {
      return stitched;
    }
    Mesh unproven;
    add_beyond(result.positions, changed, *index_, unproven);
    add_beyond(input_.positions, input_.triangles, TriangleIndex(result, options_.threads),
               unproven);
    return unproven;
  }

 private:
  void add_beyond(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                  const TriangleIndex& to, Mesh& unproven) const {
    std::vector<Triangle> beyond;
    for (const std::uint32_t i :
         find_beyond(positions, triangles, to, options_.certified_error, options_.threads)) {
      beyond.push_back(triangles[i]);
    }
    if (!beyond.empty()) append_surface(positions, beyond, unproven);
  }

  Mesh input_;
  std::optional<TriangleIndex> index_;
  const BoundedFinishOptions& options_;
};

BoundedFinish simplified(Mesh mesh, std::uint32_t locked, const SurfaceBound* bound,
                         const Manifest& manifest, const BoundedFinishOptions& options) {
  Simplifier simplifier(std::move(mesh), {.locked_vertices = locked,
                                          .positions = manifest.positions,
                                          .lines = options.lines,
                                          .bound = bound});
  if (bound != nullptr) {
    simplifier.reduce({}, [&](std::uint64_t left) {
      options.progress(left);
      return true;
    });
  }
  return {simplifier.mesh(), simplifier.dropped_degenerate(), simplifier.dropped_duplicate(),
          simplifier.turned()};
}

/// Where the proof fails, what was stitched stays as it is; in the end all of it, which has a
/// proof.
BoundedFinish finish_with_proof(Mesh stitched, std::uint32_t locked, const SurfaceBound& bound,
                                const Manifest& manifest, const BoundedFinishOptions& options) {
  const SeamProof proof(bound.surface(), options);
  for (int attempt = 0; attempt < k_attempts; ++attempt) {
    BoundedFinish finish = simplified(stitched, locked, &bound, manifest, options);
    const Mesh unproven = proof.find_unproven(stitched, locked, finish.mesh);
    if (unproven.triangles.empty()) return finish;
    const NearCells near(unproven.positions, unproven.triangles, k_reach * options.certified_error);
    std::vector<std::uint8_t> flags(stitched.positions.size(), 0);
    for (std::uint32_t v = locked; v < flags.size(); ++v) {
      const Vec3 p = stitched.positions[v];
      flags[v] = near.touch({p, p}) ? 0 : 1;
    }
    flag_unused(stitched, flags);
    locked = put_last(stitched, flags);
  }
  std::vector<std::uint8_t> flags(stitched.positions.size(), 0);
  flag_unused(stitched, flags);
  locked = put_last(stitched, flags);
  return simplified(std::move(stitched), locked, nullptr, manifest, options);
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
  return options.certified_error > 0
             ? finish_with_proof(std::move(mesh), locked, bound, manifest, options)
             : simplified(std::move(mesh), locked, &bound, manifest, options);
}

}  // namespace meshfarm
