// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/small_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/simplify/piece_sets.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// A body thinner than this share of its length has no numerically usable inside.
constexpr double k_thinnest = 1e-5;
// Rounds of rotations of all three planes: a few are enough, as each squares the residual.
constexpr int k_turns = 16;

// A piece of more triangles keeps its shape without help.
constexpr std::size_t k_few = 64;
// No piece is stretched or shrunk by more than this factor in any direction, except those of four
// triangles.
constexpr double k_most_stretch = 8;

constexpr std::uint8_t k_open = k_fixed | k_border | k_complex;

/// Diagonalises a symmetric matrix by Jacobi rotations. Returns the axes as columns.
Matrix diagonalise(Matrix& m) {
  Matrix axes{};
  for (std::size_t i = 0; i < 3; ++i) axes[i][i] = 1;
  for (int round = 0; round < k_turns; ++round) {
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>(0, 1), {0, 2}, {1, 2}}) {
      if (m[p][q] == 0) continue;
      const double ratio = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double tangent =
          (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1));
      const double cosine = 1 / std::sqrt(tangent * tangent + 1);
      const double sine = tangent * cosine;
      const auto turn = [cosine, sine](double& x, double& y) {
        const double turned = cosine * x - sine * y;
        y = sine * x + cosine * y;
        x = turned;
      };
      for (std::size_t k = 0; k < 3; ++k) turn(m[k][p], m[k][q]);
      for (std::size_t k = 0; k < 3; ++k) turn(m[p][k], m[q][k]);
      for (std::size_t k = 0; k < 3; ++k) turn(axes[k][p], axes[k][q]);
    }
  }
  return axes;
}

bool has_inside(const Matrix& diagonal) {
  const double longest = std::max({diagonal[0][0], diagonal[1][1], diagonal[2][2]});
  const double least = std::min({diagonal[0][0], diagonal[1][1], diagonal[2][2]});
  return least > k_thinnest * k_thinnest * longest && std::isfinite(longest);
}

Matrix matrix_of(const SolidMoments& moments) {
  const auto& [xx, xy, xz, yy, yz, zz] = moments.spread;
  return {{{{xx, xy, xz}}, {{xy, yy, yz}}, {{xz, yz, zz}}}};
}

Matrix multiplied(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
    }
  }
  return c;
}

/// The square root of a symmetric matrix, or its inverse; nothing if it is that of a body without
/// thickness.
std::optional<Matrix> power_of(Matrix m, double exponent) {
  const Matrix axes = diagonalise(m);
  if (!has_inside(m)) return std::nullopt;
  Matrix power{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double root = std::sqrt(m[k][k]);
    const double value = exponent < 0 ? 1 / root : root;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) power[i][j] += axes[i][k] * axes[j][k] * value;
    }
  }
  return power;
}

double volume_of(const std::array<Vec3, 4>& p) {
  return dot(p[3] - p[0], cross(p[1] - p[0], p[2] - p[0])) / 6;
}

/// The vertices of a piece of four triangles at a vertex: itself, then the others in the order of
/// its first triangle; nothing if the piece has more triangles.
std::optional<std::array<std::uint32_t, 4>> vertices_of_four(std::uint32_t vertex,
                                                             const Adjacency& adjacency) {
  const std::span<const Corner> fan = adjacency.at(vertex);
  if (fan.size() != 3) return std::nullopt;
  const auto [next, prev] = fan[0];
  std::uint32_t last = vertex;
  for (const Corner& c : fan) {
    for (const std::uint32_t v : {c.next, c.prev}) {
      if (v == next || v == prev) continue;
      if (last != vertex && last != v) return std::nullopt;
      last = v;
    }
  }
  if (last == vertex) return std::nullopt;
  const std::array<std::uint32_t, 4> all{vertex, next, prev, last};
  for (const std::uint32_t v : all) {
    if (adjacency.count(v) != 3) return std::nullopt;
  }
  return all;
}

}  // namespace

SolidMoments moments_of(std::span<const std::array<Vec3, 3>> triangles) {
  if (triangles.empty()) return {};
  const Vec3 origin = triangles[0][0];
  double volume = 0;
  Vec3 first;
  std::array<double, 6> second{};
  for (const auto& corners : triangles) {
    const Vec3 a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
    const double six = dot(a, cross(b, c));
    const Vec3 s = a + b + c;
    volume += six / 6;
    first = first + s * (six / 24);
    const auto add = [&](std::size_t place, double Vec3::*x, double Vec3::*y) {
      second[place] += six / 120 * (a.*x * (a.*y) + b.*x * (b.*y) + c.*x * (c.*y) + s.*x * (s.*y));
    };
    add(0, &Vec3::x, &Vec3::x);
    add(1, &Vec3::x, &Vec3::y);
    add(2, &Vec3::x, &Vec3::z);
    add(3, &Vec3::y, &Vec3::y);
    add(4, &Vec3::y, &Vec3::z);
    add(5, &Vec3::z, &Vec3::z);
  }
  if (volume == 0) return {};
  const Vec3 g = first * (1 / volume);
  const std::array<double, 6> of_center{g.x * g.x, g.x * g.y, g.x * g.z,
                                        g.y * g.y, g.y * g.z, g.z * g.z};
  SolidMoments moments{volume, origin + g, {}};
  for (std::size_t i = 0; i < 6; ++i) moments.spread[i] = second[i] / volume - of_center[i];
  return moments;
}

std::optional<std::array<Vec3, 4>> tetrahedron_like(const SolidMoments& moments) {
  Matrix m = matrix_of(moments);
  const Matrix axes = diagonalise(m);
  if (!has_inside(m)) return std::nullopt;
  std::array<Vec3, 3> half{};
  for (std::size_t i = 0; i < 3; ++i) {
    // For a tetrahedron in a cube of half the side 1 it is 1 / 5.
    half[i] = Vec3{axes[0][i], axes[1][i], axes[2][i]} * std::sqrt(5 * m[i][i]);
  }
  const auto [u, v, w] = half;
  const Vec3 c = moments.center;
  return std::array<Vec3, 4>{c + u + v + w, c + u - v - w, c - u + v - w, c - u - v + w};
}

Vec3 AffineMap::operator()(Vec3 p) const {
  const Vec3 d = p - from;
  const auto row = [&](std::size_t i) {
    return matrix[i][0] * d.x + matrix[i][1] * d.y + matrix[i][2] * d.z;
  };
  return to + Vec3{row(0), row(1), row(2)};
}

/// With the spreads S and T: R^-1 (R T R)^1/2 R^-1, where R R = S.
std::optional<AffineMap> map_between(const SolidMoments& from, const SolidMoments& to) {
  if (!(from.volume * to.volume > 0)) return std::nullopt;
  const auto root = power_of(matrix_of(from), 0.5);
  const auto inverse = power_of(matrix_of(from), -0.5);
  if (!root || !inverse) return std::nullopt;
  const auto middle = power_of(multiplied(multiplied(*root, matrix_of(to)), *root), 0.5);
  if (!middle) return std::nullopt;
  const Matrix all = multiplied(multiplied(*inverse, *middle), *inverse);
  Matrix stretches = all;
  diagonalise(stretches);
  for (std::size_t i = 0; i < 3; ++i) {
    const double stretch = stretches[i][i];
    if (!(stretch < k_most_stretch && stretch * k_most_stretch > 1)) return std::nullopt;
  }
  return AffineMap{from.center, to.center, all};
}

void SmallPieces::find(const Mesh& mesh, std::span<const std::uint8_t> flags) {
  PieceSets sets(mesh, flags);
  of_vertex_.clear();
  moments_.assign(1, {});
  left_over_.assign(1, 0);
  std::vector<std::uint32_t> number(sets.nodes(), 0);
  std::vector<std::vector<std::array<Vec3, 3>>> triangles(1);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t set = sets.of_triangle(i);
    if (!sets.is_small(set) || sets.touches(set)) continue;
    if (number[set] == 0) {
      number[set] = static_cast<std::uint32_t>(triangles.size());
      triangles.emplace_back();
    }
    const Triangle& t = mesh.triangles[i];
    triangles[number[set]].push_back(
        {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  if (triangles.size() == 1) return;
  of_vertex_.assign(mesh.positions.size(), 0);
  for (std::uint32_t v = 0; v < of_vertex_.size(); ++v) {
    if ((flags[v] & k_complex) == 0) of_vertex_[v] = number[sets.of_vertex(v)];
  }
  for (std::size_t i = 1; i < triangles.size(); ++i) moments_.push_back(moments_of(triangles[i]));
  left_over_.resize(moments_.size(), 0);
}

void SmallPieces::find_at(std::span<const std::uint32_t> vertices, const Adjacency& adjacency,
                          std::span<const Vec3> positions, std::span<const std::uint8_t> flags) {
  const auto first_new = static_cast<std::uint32_t>(moments_.size());
  for (const std::uint32_t start : vertices) {
    if (adjacency.count(start) == 0) continue;
    if (!empty() && of_vertex_[start] >= first_new) continue;
    std::vector<std::uint32_t> reached{start};
    std::vector<std::array<Vec3, 3>> triangles;
    bool is_piece = true;
    for (std::size_t i = 0; i < reached.size() && is_piece; ++i) {
      const std::uint32_t v = reached[i];
      is_piece = (flags[v] & k_open) == 0 && triangles.size() <= k_few;
      for (const auto& [next, prev] : adjacency.at(v)) {
        if (v < next && v < prev) {
          triangles.push_back({positions[v], positions[next], positions[prev]});
        }
        for (const std::uint32_t other : {next, prev}) {
          if (std::find(reached.begin(), reached.end(), other) == reached.end()) {
            reached.push_back(other);
          }
        }
      }
    }
    if (!is_piece) continue;
    if (empty()) {
      of_vertex_.assign(positions.size(), 0);
      moments_.assign(1, {});
      left_over_.assign(1, 0);
    }
    for (const std::uint32_t v : reached)
      of_vertex_[v] = static_cast<std::uint32_t>(moments_.size());
    moments_.push_back(moments_of(triangles));
    left_over_.push_back(triangles.size() <= 4 ? 1 : 0);
  }
}

void SmallPieces::compact(std::span<const std::uint32_t> target) {
  if (empty()) return;
  std::size_t kept = 0;
  for (std::uint32_t v = 0; v < target.size(); ++v) {
    of_vertex_[kept] = of_vertex_[v];
    kept += target[v] == v ? 1 : 0;
  }
  of_vertex_.resize(kept);
}

std::optional<SmallPieces::Places> SmallPieces::placed(std::array<std::uint32_t, 4> vertices,
                                                       const SolidMoments& moments,
                                                       PositionType type) const {
  auto places = tetrahedron_like(moments);
  if (!places) return std::nullopt;
  for (Vec3& p : *places) p = rounded(p, type);
  // The triangle of the first three faces away from the fourth if the volume is positive.
  if ((volume_of(*places) < 0) != (moments.volume > 0)) std::swap((*places)[1], (*places)[2]);
  return Places{{vertices.begin(), vertices.end()}, {places->begin(), places->end()}};
}

std::optional<SmallPieces::Places> SmallPieces::tetrahedron_at(std::uint32_t vertex,
                                                               const Adjacency& adjacency,
                                                               PositionType type) const {
  if (empty() || of_vertex_[vertex] == 0) return std::nullopt;
  const auto vertices = vertices_of_four(vertex, adjacency);
  if (!vertices) return std::nullopt;
  return placed(*vertices, moments_[of_vertex_[vertex]], type);
}

std::vector<SmallPieces::Places> SmallPieces::restored(std::span<const Triangle> triangles,
                                                       std::span<const Vec3> positions,
                                                       PositionType type) const {
  std::vector<Places> all;
  if (empty()) return all;
  std::vector<std::vector<Triangle>> of_piece(moments_.size());
  for (const Triangle& t : triangles) {
    const std::uint32_t piece = of_vertex_[t[0]];
    if (piece != 0 && of_piece[piece].size() <= k_few) of_piece[piece].push_back(t);
  }
  for (std::size_t piece = 1; piece < moments_.size(); ++piece) {
    const std::vector<Triangle>& own = of_piece[piece];
    if (own.size() < 4 || own.size() > k_few) continue;
    Places places;
    std::vector<std::array<Vec3, 3>> corners;
    for (const Triangle& t : own) {
      places.vertices.insert(places.vertices.end(), t.begin(), t.end());
      corners.push_back({positions[t[0]], positions[t[1]], positions[t[2]]});
    }
    std::vector<std::uint32_t>& vertices = places.vertices;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (own.size() == 4) {
      if (vertices.size() != 4) continue;
      const Triangle& t = own[0];
      const auto is_other = [&](std::uint32_t v) {
        return std::find(t.begin(), t.end(), v) == t.end();
      };
      const auto other = std::find_if(vertices.begin(), vertices.end(), is_other);
      if (auto four = placed({t[0], t[1], t[2], *other}, moments_[piece], type)) {
        all.push_back(std::move(*four));
      }
      continue;
    }
    const auto map = map_between(moments_of(corners), moments_[piece]);
    if (!map) continue;
    for (const std::uint32_t v : vertices) {
      places.positions.push_back(rounded((*map)(positions[v]), type));
    }
    all.push_back(std::move(places));
  }
  return all;
}

}  // namespace meshfarm
