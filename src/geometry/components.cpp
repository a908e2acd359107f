// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/distance.hpp>

#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

/// At most this many triangles per component vote, by area, on what it was before.
constexpr std::size_t k_voters = 63;
/// A component with at least this share of the area that no other is taken for is searched for
/// separately: close sheets may have all vertices of another sheet nearer to them.
constexpr double k_large_component = 0.05;
constexpr std::size_t k_looked_for = 1000;  // points

UnionFind components_of(const Mesh& mesh) {
  UnionFind pieces(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  return pieces;
}

double area_of(const Mesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.positions[t[0]];
  return 0.5 * length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
}

Vec3 middle_of(const Mesh& mesh, const Triangle& t) {
  return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3);
}

/// Some triangles of each component, spread over it. Vertices would not do: all vertices of a floor
/// may be at the feet of things that stand on it.
std::map<std::uint32_t, std::vector<std::uint32_t>> voters_of(const Mesh& mesh) {
  UnionFind pieces = components_of(mesh);
  std::map<std::uint32_t, std::vector<std::uint32_t>> voters;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    voters[pieces.find(mesh.triangles[i][0])].push_back(i);
  }
  for (auto& [piece, all] : voters) {
    const std::size_t step = (all.size() + k_voters - 1) / k_voters;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.size(); i += step) all[kept++] = all[i];
    all.resize(kept);
  }
  return voters;
}

/// The key of the greatest value; if equal, the least key.
std::uint32_t key_of_most(const std::map<std::uint32_t, double>& values) {
  return std::max_element(values.begin(), values.end(),
                          [](const auto& x, const auto& y) { return x.second < y.second; })
      ->first;
}

/// Whether most of the component's triangles are much nearer to `after` than to the others of
/// `before`.
bool is_found(const Mesh& before, UnionFind& pieces, std::uint32_t piece,
              const DistanceMeter& after, unsigned threads) {
  Mesh others;
  others.positions = before.positions;
  std::vector<Vec3> middles;
  for (const Triangle& t : before.triangles) {
    if (pieces.find(t[0]) != piece) {
      others.triangles.push_back(t);
      continue;
    }
    middles.push_back(middle_of(before, t));
  }
  if (others.triangles.empty()) return true;
  const std::size_t step = (middles.size() + k_looked_for - 1) / k_looked_for;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < middles.size(); i += step) points.push_back(middles[i]);
  const auto distances_by = [&](const DistanceMeter& meter) {
    std::vector<double> distances(points.size());
    const DistanceMeter::Points all = points;
    meter.measure_each({&all, 1}, distances);
    return distances;
  };
  const std::vector<double> there = distances_by(after);
  const std::vector<double> elsewhere = distances_by(DistanceMeter(others, threads));
  std::size_t found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) found += there[i] < 0.5 * elsewhere[i] ? 1 : 0;
  return 2 * found > points.size();
}

}  // namespace

DroppedComponents drop_small_components(Mesh& mesh, double diagonal) {
  if (!(diagonal > 0)) return {};  // no diagonal is below 0
  UnionFind pieces = components_of(mesh);
  std::vector<Box> boxes(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) boxes[pieces.find(corner)].add(mesh.positions[corner]);
  }
  DroppedComponents dropped;
  for (const Box& box : boxes) {
    if (!box.empty() && box.diagonal() < diagonal) ++dropped.components;
  }
  dropped.triangles = keep_triangles(mesh, [&](std::size_t i) {
    return !(boxes[pieces.find(mesh.triangles[i][0])].diagonal() < diagonal);
  });
  return dropped;
}

std::vector<std::uint32_t> lowest_connected(std::size_t vertices,
                                            std::span<const Triangle> triangles) {
  UnionFind pieces(vertices);
  for (const Triangle& t : triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  std::vector<std::uint32_t> lowest(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) lowest[v] = pieces.find(v);
  return lowest;
}

GoneComponents find_gone_components(const Mesh& before, const Mesh& after, unsigned threads) {
  UnionFind pieces = components_of(before);
  std::vector<double> areas(before.positions.size(), -1);  // of those not found again
  GoneComponents gone;
  for (const Triangle& t : before.triangles) {
    double& area = areas[pieces.find(t[0])];
    area = std::max(area, 0.0) + area_of(before, t);
    gone.area_of_all += area_of(before, t);
  }
  const DistanceMeter meter(before, threads);
  std::map<std::uint32_t, double> votes;
  for (const auto& [piece, voters] : voters_of(after)) {
    votes.clear();
    for (const std::uint32_t i : voters) {
      const Triangle& t = after.triangles[i];
      const std::uint32_t nearest = meter.nearest_triangle(middle_of(after, t));
      votes[pieces.find(before.triangles[nearest][0])] += area_of(after, t);
    }
    areas[key_of_most(votes)] = -1;
  }
  std::optional<DistanceMeter> to_after;
  const auto is_there = [&](std::uint32_t piece) {
    if (after.triangles.empty() || !(areas[piece] > k_large_component * gone.area_of_all))
      return false;
    if (!to_after) to_after.emplace(after, threads);
    return is_found(before, pieces, piece, *to_after, threads);
  };
  for (std::uint32_t piece = 0; piece < areas.size(); ++piece) {
    if (areas[piece] < 0 || is_there(piece)) continue;
    ++gone.components;
    gone.area += areas[piece];
  }
  return gone;
}

}  // namespace meshfarm
