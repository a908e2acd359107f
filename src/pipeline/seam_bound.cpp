// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Why a proof holds although several groups of seams are changed at once: each point of the input
// has some point of the earlier surface within the bound. If that point lies on a triangle that
// nobody changes, it stays. Otherwise the group that changes the triangle proves the point again:
// by the new triangles and by those that nobody changes, but not by triangles that another group
// may change. Input that it can't prove that way from the start is left to the other groups, and
// everything near it stays unchanged.
#include "pipeline/seam_bound.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/geometry/vertices.hpp>

#include "pipeline/beyond_bound.hpp"
#include "pipeline/bound_proof.hpp"

namespace meshfarm {
namespace {

/// In multiples of the bound: anything farther from a surface than this cannot affect its
/// simplification.
constexpr double k_bound_reach = 2;
/// How often unproven areas are left unchanged before everything is.
constexpr int k_proof_attempts = 4;

bool may_change(const SeamMesh& seams, const Triangle& t) {
  return *std::max_element(t.begin(), t.end()) >= seams.locked;
}

/// Locks the vertices that are not flagged, and unlocks those that no triangle uses, so that they
/// go.
void lock_others(std::vector<std::uint8_t> flags, SeamMesh& seams) {
  std::vector<std::uint8_t> used(flags.size(), 0);
  for (const auto& [a, b, c] : seams.mesh.triangles) used[a] = used[b] = used[c] = 1;
  for (std::size_t v = seams.kept; v < flags.size(); ++v) {
    if (used[v] == 0) flags[v] = 1;
  }
  seams.locked = put_last(seams.mesh, flags);
}

/// Flags all vertices but the first `locked`.
std::vector<std::uint8_t> free_flags(const SeamMesh& seams) {
  std::vector<std::uint8_t> flags(seams.mesh.positions.size(), 1);
  std::fill_n(flags.begin(), seams.locked, std::uint8_t{0});
  return flags;
}

/// Triangles that do not change, sorted by their places.
std::vector<TrianglePlaces> fixed_places(const SeamMesh& seams) {
  std::vector<TrianglePlaces> fixed;
  for (const Triangle& t : seams.mesh.triangles) {
    if (!may_change(seams, t) && !is_degenerate(t)) fixed.push_back(places_of(seams.mesh, t));
  }
  std::sort(fixed.begin(), fixed.end());
  return fixed;
}

/// Whether all of these are still in the mesh. Also collects the other triangles.
bool are_kept(const std::vector<TrianglePlaces>& fixed, const Mesh& mesh,
              std::vector<Triangle>& others) {
  std::vector<std::uint8_t> is_there(fixed.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const auto [first, last] = std::equal_range(fixed.begin(), fixed.end(), places_of(mesh, t));
    if (first == last) others.push_back(t);
    std::fill(is_there.begin() + (first - fixed.begin()), is_there.begin() + (last - fixed.begin()),
              std::uint8_t{1});
  }
  return std::find(is_there.begin(), is_there.end(), 0) == is_there.end();
}

/// Leaves out the triangles of these numbers, which are ascending.
void drop_numbered(const std::vector<std::uint32_t>& numbers, std::vector<Triangle>& triangles) {
  TriangleColumns none;
  std::size_t next = 0;
  keep_triangles(triangles, none, [&](std::size_t i) {
    if (next == numbers.size() || numbers[next] != i) return true;
    ++next;
    return false;
  });
}

/// Proves the changes around the seams. What is farther away was proven before, part by part.
class SeamProof {
 public:
  /// `input`: all of it that is near what may change.
  SeamProof(Mesh input, const BoundedFinishOptions& options)
      : input_(std::move(input)), options_(options) {
    drop_coincident_corners(input_);
    to_prove_ = input_.triangles;
    if (!input_.triangles.empty()) index_.emplace(input_, options.threads);
  }

  /// Locks everything near input that cannot be proven without the unsure triangles.
  void leave_to_others(SeamMesh& seams) {
    if (seams.first_unsure == seams.end_unsure) return;
    const std::vector<std::uint32_t> beyond = numbers_beyond(sure_part(seams, seams.mesh));
    if (beyond.empty()) return;
    const NearCells near(input_.positions, picked(to_prove_, beyond),
                         k_bound_reach * options_.certified_error);
    std::vector<std::uint8_t> flags = free_flags(seams);
    for (const std::uint32_t i : near.touching(seams.mesh.positions, seams.mesh.triangles)) {
      for (const std::uint32_t v : seams.mesh.triangles[i]) flags[v] = 0;
    }
    lock_others(std::move(flags), seams);
    drop_numbered(beyond, to_prove_);
  }

  /// The unproven triangles of a result and of the input.
  Mesh find_unproven(const SeamMesh& before, const Mesh& result) const {
    std::vector<Triangle> changed;
    if (!index_ || result.triangles.empty() || !are_kept(fixed_places(before), result, changed)) {
      return before.mesh;
    }
    Mesh unproven;
    add(result.positions, changed,
        find_beyond(result.positions, changed, *index_, options_.certified_error, options_.threads),
        unproven);
    const bool is_all_sure = before.first_unsure == before.end_unsure;
    add(input_.positions, to_prove_,
        is_all_sure ? numbers_beyond(result) : numbers_beyond(sure_part(before, result)), unproven);
    return unproven;
  }

 private:
  /// Locked vertices have the same numbers in the result.
  static Mesh sure_part(const SeamMesh& seams, const Mesh& result) {
    Mesh sure;
    sure.positions = result.positions;
    const auto is_unsure = [&](std::uint32_t v) {
      return v >= seams.first_unsure && v < seams.end_unsure;
    };
    std::copy_if(result.triangles.begin(), result.triangles.end(),
                 std::back_inserter(sure.triangles),
                 [&](const Triangle& t) { return !std::all_of(t.begin(), t.end(), is_unsure); });
    return sure;
  }

  /// Triangles of the input that are not proven to be near.
  std::vector<std::uint32_t> numbers_beyond(const Mesh& surface) const {
    if (!surface.triangles.empty()) {
      return find_beyond(input_.positions, to_prove_, TriangleIndex(surface, options_.threads),
                         options_.certified_error, options_.threads);
    }
    std::vector<std::uint32_t> all(to_prove_.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }

  static void add(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                  const std::vector<std::uint32_t>& numbers, Mesh& unproven) {
    if (!numbers.empty()) append_surface(positions, picked(triangles, numbers), unproven);
  }

  static std::vector<Triangle> picked(std::span<const Triangle> triangles,
                                      const std::vector<std::uint32_t>& numbers) {
    std::vector<Triangle> picked;
    picked.reserve(numbers.size());
    for (const std::uint32_t i : numbers) picked.push_back(triangles[i]);
    return picked;
  }

  Mesh input_;
  std::vector<Triangle> to_prove_;  // of the input
  std::optional<TriangleIndex> index_;
  const BoundedFinishOptions& options_;
};

BoundedFinish simplified(SeamMesh seams, const SurfaceBound* bound,
                         const BoundedFinishOptions& options) {
  Simplifier simplifier(std::move(seams.mesh), {.locked_vertices = seams.locked,
                                                .positions = options.positions,
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

/// Where the proof fails, the old surface stays; in the end all of it, which has a proof.
BoundedFinish simplified_with_proof(SeamMesh seams, const SurfaceBound& bound,
                                    const BoundedFinishOptions& options) {
  SeamProof proof(bound.surface(), options);
  proof.leave_to_others(seams);
  for (int attempt = 0; attempt < k_proof_attempts; ++attempt) {
    BoundedFinish finish = simplified(seams, &bound, options);
    const Mesh unproven = proof.find_unproven(seams, finish.mesh);
    if (unproven.triangles.empty()) return finish;
    const NearCells near(unproven.positions, unproven.triangles,
                         k_bound_reach * options.certified_error);
    std::vector<std::uint8_t> flags(seams.mesh.positions.size(), 0);
    for (std::uint32_t v = seams.locked; v < flags.size(); ++v) {
      const Vec3 p = seams.mesh.positions[v];
      flags[v] = near.touch({p, p}) ? 0 : 1;
    }
    lock_others(std::move(flags), seams);
  }
  lock_others(std::vector<std::uint8_t>(seams.mesh.positions.size(), 0), seams);
  return simplified(std::move(seams), nullptr, options);
}

/// Input that is too far from `after` but not from `before`. The rest of the input is near what
/// lies beside the seams.
Mesh part_lost(const Mesh& input, const TriangleIndex& before, const Mesh& after, double most,
               unsigned threads) {
  Mesh beyond = part_beyond(input, TriangleIndex(after, threads), most, threads);
  drop_numbered(find_beyond(beyond.positions, beyond.triangles, before, most, threads),
                beyond.triangles);
  return beyond;
}

/// If the result goes too far where the old surface did not, the old surface stays there.
BoundedFinish simplified_and_measured(SeamMesh seams, const SurfaceBound& bound,
                                      const BoundedFinishOptions& options) {
  const double most = k_most_beyond_of_seam * options.max_error;
  AstrayFinder finder(bound.index(), most, options.threads);
  const Mesh before = seams.mesh;
  finder.pass_over(before);
  const TriangleIndex index_before(before, options.threads);
  for (int tries = 1;; ++tries) {
    BoundedFinish finish = simplified(seams, &bound, options);
    if (finish.mesh.triangles.empty() || tries == k_bounded_tries) return finish;
    options.progress(finish.mesh.triangles.size());
    const Mesh astray = finder.find(finish.mesh);
    const Mesh lost = part_lost(bound.surface(), index_before, finish.mesh, most, options.threads);
    if (astray.triangles.empty() && lost.triangles.empty()) return finish;
    const std::uint32_t locked = seams.locked;
    std::vector<std::uint8_t> flags = free_flags(seams);
    clear_touched(astray, reach_of_astray(tries) * options.max_error, seams.mesh, flags);
    clear_touched(lost, most, seams.mesh, flags);
    lock_others(std::move(flags), seams);
    if (seams.locked == locked) return finish;  // another try would give the same
  }
}

}  // namespace

NearCells cells_round_changes(const SeamMesh& seams, const BoundedFinishOptions& options) {
  std::vector<Triangle> changing;
  const std::vector<Triangle>& all = seams.mesh.triangles;
  std::copy_if(all.begin(), all.end(), std::back_inserter(changing),
               [&](const Triangle& t) { return may_change(seams, t); });
  return {seams.mesh.positions, changing, k_bound_reach * options.max_error};
}

void add_near(std::span<const Vec3> positions, std::span<const Triangle> triangles,
              const NearCells& near, Mesh& mesh) {
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (const Triangle& t : triangles) {
    Box box;
    for (const std::uint32_t v : t) box.add(positions[v]);
    if (near.touch(box)) append_triangle(positions, t, number, mesh);
  }
}

BoundedFinish simplify_seams(SeamMesh seams, Mesh input, const BoundedFinishOptions& options) {
  if (input.triangles.empty()) return simplified(std::move(seams), nullptr, options);
  const SurfaceBound bound(std::move(input), {options.max_error, options.threads, true});
  return options.certified_error > 0 ? simplified_with_proof(std::move(seams), bound, options)
                                     : simplified_and_measured(std::move(seams), bound, options);
}

}  // namespace meshfarm
