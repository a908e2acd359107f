// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/geometry/facing_repair.hpp>
#include <meshfarm/geometry/surface_places.hpp>

#include "geometry/mesh_change.hpp"
#include "geometry/turned.hpp"

namespace meshfarm {
namespace {

/// Distances that differ only by rounding are the same.
constexpr double k_same = 1 + 1e-9;
constexpr std::size_t k_small_piece = 16;  // triangles
/// Limits on the distance of changed places from the original, as shares of the reach. The smaller
/// one, which costs less, is tried first.
constexpr std::array k_limits{0.25, 0.5};

Vec3 center_of(const TriangleCorners& t) {
  return (t[0] + t[1] + t[2]) * (1.0 / 3);
}

Vec3 normal_of(const TriangleCorners& t) {
  return cross(t[1] - t[0], t[2] - t[0]);
}

bool is_turned(Vec3 was, Vec3 now) {
  constexpr double k_cos_60_squared = 0.25;
  const double along = dot(was, now);
  return along <= 0 || along * along < k_cos_60_squared * squared_length(was) * squared_length(now);
}

/// The original, as triangles ask about it.
class NearOriginal {
 public:
  NearOriginal(const Mesh& original, double reach)
      : original_(original), places_(original, {.reach = reach, .threads = 0}) {}

  /// Whether the place nearest to the centre faces the other way, and none equally near faces this
  /// way.
  bool is_behind(const TriangleCorners& t) const {
    const Vec3 normal = normal_of(t);
    if (!(squared_length(normal) > 0)) return false;
    const Vec3 center = center_of(t);
    const SurfacePlace nearest = places_.find(center, {});
    if (!(dot(meshfarm::normal_of(original_, nearest.triangle), normal) < 0)) return false;
    const SurfacePlace facing = places_.find(center, normal, nearest.triangle);
    return facing.triangle == nearest.triangle || facing.squared > k_same * nearest.squared;
  }
  double squared_distance(Vec3 p) const { return places_.find(p, {}).squared; }

  /// The vector from the centre to the nearest place that faces as the triangle does.
  std::optional<Vec3> way_to_facing(const TriangleCorners& t) const {
    const Vec3 center = center_of(t), normal = normal_of(t);
    const SurfacePlace place = places_.find(center, normal);
    if (!(dot(meshfarm::normal_of(original_, place.triangle), normal) > 0)) return std::nullopt;
    const auto& [a, b, c] = original_.triangles[place.triangle];
    return original_.positions[a] * place.shares[0] + original_.positions[b] * place.shares[1] +
           original_.positions[c] * place.shares[2] - center;
  }

 private:
  const Mesh& original_;
  SurfacePlaces places_;
};

/// Tries one change after the other.
class TriangleMender {
 public:
  TriangleMender(ChangingMesh& mesh, const NearOriginal& original,
                 const FacingRepairOptions& options)
      : changing_(mesh), mesh_(mesh.mesh()), original_(original), options_(options) {}

  void mend(std::uint32_t triangle) {
    for (const double share : k_limits) {
      squared_limit_ = share * share * options_.reach * options_.reach;
      if (flip(triangle) || move_across(triangle) || move_towards(triangle) ||
          change_piece(triangle)) {
        return;
      }
    }
  }

 private:
  /// Whether a new place is farther from the original than the limit, and than the old place.
  bool is_too_far(Vec3 now, Vec3 was) const {
    const double squared = original_.squared_distance(now);
    return squared > squared_limit_ && squared > original_.squared_distance(was);
  }

  /// Applies the change if it leaves fewer triangles facing the wrong way, and makes nothing else
  /// worse.
  bool improve(const MeshChange& change) {
    for (const auto& [vertex, place] : change.moved) {
      if (!is_finite(place) || is_too_far(place, mesh_.positions[vertex])) return false;
    }
    const std::vector<std::uint32_t> concerned = changing_.concerned_by(change);
    int fewer = 0;
    for (const std::uint32_t triangle : concerned) {
      const TriangleCorners was = changing_.corners_of(triangle);
      const TriangleCorners now = changing_.corners_after(triangle, change);
      if (!(squared_length(normal_of(now)) > 0)) return false;
      if (is_too_far(center_of(now), center_of(was))) return false;
      const bool was_behind = original_.is_behind(was);
      const bool may_turn = was_behind || !change.rewired.empty();
      if (!may_turn && is_turned(normal_of(was), normal_of(now))) return false;
      fewer += int{was_behind} - int{original_.is_behind(now)};
    }
    return fewer > 0 && changing_.apply(change, concerned);
  }

  /// Flips an edge, the longest first.
  bool flip(std::uint32_t triangle) {
    if (!mesh_.columns.empty() || !mesh_.appearances.empty()) return false;
    const TriangleCorners corners = changing_.corners_of(triangle);
    const auto squared = [&](std::size_t k) {
      return squared_length(corners[(k + 1) % 3] - corners[k]);
    };
    std::array<std::size_t, 3> edges{0, 1, 2};
    std::stable_sort(edges.begin(), edges.end(),
                     [&](std::size_t a, std::size_t b) { return squared(a) > squared(b); });
    return std::any_of(edges.begin(), edges.end(),
                       [&](std::size_t k) { return flip_edge(triangle, k); });
  }
  bool flip_edge(std::uint32_t triangle, std::size_t edge) {
    const Triangle& t = mesh_.triangles[triangle];
    const std::uint32_t a = t[edge], b = t[(edge + 1) % 3], c = t[(edge + 2) % 3];
    const std::optional<std::uint32_t> other = changing_.beside(a, b);
    if (!other) return false;
    const Triangle& u = mesh_.triangles[*other];
    const std::uint32_t d =
        *std::find_if(u.begin(), u.end(), [&](std::uint32_t v) { return v != a && v != b; });
    if (c == d || are_joined(c, d)) return false;
    const MeshChange change{{}, {{triangle, {c, a, d}}, {*other, {d, b, c}}}};
    const Vec3 way =
        normal_of(changing_.corners_of(triangle)) + normal_of(changing_.corners_of(*other));
    for (const auto& [which, now] : change.rewired) {
      if (!(dot(normal_of(changing_.corners_after(which, change)), way) > 0)) return false;
    }
    return improve(change);
  }
  bool are_joined(std::uint32_t a, std::uint32_t b) const {
    const std::span<const std::uint32_t> around = changing_.fan(a);
    return std::any_of(around.begin(), around.end(), [&](std::uint32_t triangle) {
      const Triangle& t = mesh_.triangles[triangle];
      return std::find(t.begin(), t.end(), b) != t.end();
    });
  }

  Vec3 kept(Vec3 p) const { return rounded(p, options_.positions); }

  /// Moves a corner to the other side of the opposite edge, the nearest corner first.
  bool move_across(std::uint32_t triangle) {
    const Triangle t = mesh_.triangles[triangle];
    std::vector<std::pair<std::uint32_t, Vec3>> ways;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh_.positions[t[k]], a = mesh_.positions[t[(k + 1) % 3]];
      const Vec3 edge = mesh_.positions[t[(k + 2) % 3]] - a;
      const double squared = squared_length(edge);
      if (squared > 0) ways.emplace_back(t[k], a + edge * (dot(p - a, edge) / squared) - p);
    }
    std::stable_sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) {
      return squared_length(a.second) < squared_length(b.second);
    });
    for (const auto& [vertex, way] : ways) {
      if (!changing_.is_inside(vertex)) continue;
      for (const double share : {1.25, 2.0}) {
        if (share * length(way) > options_.reach) break;
        if (improve({{{vertex, kept(mesh_.positions[vertex] + way * share)}}, {}})) return true;
      }
    }
    return false;
  }

  /// Moves one, two or all three vertices towards the nearest place that faces the same way.
  bool move_towards(std::uint32_t triangle) {
    const Triangle t = mesh_.triangles[triangle];
    const std::optional<Vec3> way = original_.way_to_facing(changing_.corners_of(triangle));
    if (!way) return false;
    for (const double share : {0.5, 1.0, 1.5, 2.0, 3.0}) {
      if (share * length(*way) > options_.reach) break;
      for (const unsigned which : {1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
        MeshChange change;
        bool may_move = true;
        for (std::size_t k = 0; k < 3; ++k) {
          if ((which >> k & 1U) == 0) continue;
          may_move = may_move && changing_.is_inside(t[k]);
          change.moved.emplace_back(t[k], kept(mesh_.positions[t[k]] + *way * share));
        }
        if (may_move && improve(change)) return true;
      }
    }
    return false;
  }

  /// Moves or widens a small piece.
  bool change_piece(std::uint32_t triangle) {
    const std::vector<std::uint32_t> piece = small_piece_of(triangle);
    if (piece.empty()) return false;
    Vec3 center{};
    for (const std::uint32_t v : piece) center = center + mesh_.positions[v];
    center = center * (1 / static_cast<double>(piece.size()));
    const Vec3 way =
        original_.way_to_facing(changing_.corners_of(triangle)).value_or(Vec3{0, 0, 0});
    for (const double scale : {1.0, 1.25, 1.5, 2.0, 2.5}) {
      for (const double share : {0.0, 0.5, 1.0}) {
        MeshChange change;
        for (const std::uint32_t v : piece) {
          const Vec3 wide = center + (mesh_.positions[v] - center) * scale;
          change.moved.emplace_back(v, kept(wide + way * share));
        }
        if (improve(change)) return true;
      }
    }
    return false;
  }

  /// The vertices of the triangle's piece, if that is closed and has few triangles; otherwise none.
  std::vector<std::uint32_t> small_piece_of(std::uint32_t triangle) const {
    std::vector<std::uint32_t> triangles{triangle}, vertices;
    for (std::size_t i = 0; i < triangles.size() && triangles.size() <= k_small_piece; ++i) {
      for (const std::uint32_t v : mesh_.triangles[triangles[i]]) {
        if (std::find(vertices.begin(), vertices.end(), v) != vertices.end()) continue;
        if (!changing_.is_inside(v)) return {};
        vertices.push_back(v);
        for (const std::uint32_t beside : changing_.fan(v)) {
          const bool is_new =
              std::find(triangles.begin(), triangles.end(), beside) == triangles.end();
          if (is_new) triangles.push_back(beside);
        }
      }
    }
    return triangles.size() <= k_small_piece ? vertices : std::vector<std::uint32_t>{};
  }

  ChangingMesh& changing_;
  const Mesh& mesh_;
  const NearOriginal& original_;
  FacingRepairOptions options_;
  double squared_limit_ = 0;  // of distances from the original
};

}  // namespace

class FacingRepair::Impl {
 public:
  Impl(Mesh& mesh, const FacingRepairOptions& options) : mesh_(mesh), options_(options) {}

  FacingMended mend(std::span<const std::uint32_t> triangles, const Mesh& near) {
    if (near.triangles.empty()) return {};
    const NearOriginal original(near, options_.reach);
    std::vector<std::uint32_t> wrong;
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(wrong),
                 [&](std::uint32_t triangle) { return is_behind(original, triangle); });
    if (wrong.empty()) return {};
    if (!changing_) changing_.emplace(mesh_);
    TriangleMender mender(*changing_, original, options_);
    for (const std::uint32_t triangle : wrong) {
      // It may have been repaired together with another one.
      if (is_behind(original, triangle)) mender.mend(triangle);
    }
    const auto mended = std::count_if(wrong.begin(), wrong.end(), [&](std::uint32_t triangle) {
      return !is_behind(original, triangle);
    });
    return {wrong.size(), static_cast<std::uint64_t>(mended)};
  }

 private:
  bool is_behind(const NearOriginal& original, std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return original.is_behind({mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]});
  }

  Mesh& mesh_;
  FacingRepairOptions options_;
  std::optional<ChangingMesh> changing_;
};

FacingRepair::FacingRepair(Mesh& mesh, const FacingRepairOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}
FacingRepair::~FacingRepair() = default;

FacingMended FacingRepair::mend(std::span<const std::uint32_t> triangles, const Mesh& original) {
  return impl_->mend(triangles, original);
}

}  // namespace meshfarm
