// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace meshfarm::test {

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Mesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

Mesh box(Vec3 size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({i % 2 * size.x, i / 2 % 2 * size.y, i / 4 * size.z});
  }
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

Mesh icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh{{{-1, g, 0},
             {1, g, 0},
             {-1, -g, 0},
             {1, -g, 0},
             {0, -1, g},
             {0, 1, g},
             {0, -1, -g},
             {0, 1, -g},
             {g, 0, -1},
             {g, 0, 1},
             {-g, 0, -1},
             {-g, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5);
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.positions) p = p * (1 / length(p));
  return mesh;
}

Mesh torus(std::uint32_t rows, std::uint32_t columns) {
  const double turn = 2 * std::acos(-1.0);
  Mesh mesh;
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double u = turn * i / rows, v = turn * j / columns;
      const double radius = 1 + 0.4 * std::cos(v);
      mesh.positions.push_back({radius * std::cos(u), radius * std::sin(u), 0.4 * std::sin(v)});
      const std::uint32_t down = (i + 1) % rows, right = (j + 1) % columns;
      const std::uint32_t a = i * columns + j, b = down * columns + j;
      const std::uint32_t c = down * columns + right, d = i * columns + right;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

Mesh torus_with_neck(std::uint32_t rows, std::uint32_t columns) {
  Mesh mesh = torus(rows, columns);
  for (std::uint32_t i = 1; i < columns; ++i) mesh.positions[i] = mesh.positions[0];
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

Mesh torus_with_necks(std::uint32_t rows, std::uint32_t columns) {
  Mesh mesh = torus(rows, columns);
  for (std::uint32_t row = 0; row < rows; row += 3) {
    for (std::uint32_t i = 1; i < columns; ++i) {
      mesh.positions[row * columns + i] = mesh.positions[row * columns];
    }
  }
  return mesh;
}

Mesh touching_row(std::uint32_t count, bool at_edges) {
  const Mesh first = octahedron();
  const Vec3 step = at_edges ? Vec3{1, 1, 0} : Vec3{2, 0, 0};
  Mesh row;
  for (std::uint32_t i = 0; i < count; ++i) {
    Mesh next = first;
    for (Vec3& p : next.positions) p = p + step * static_cast<double>(i);
    append(row, next);
  }
  return row;
}

Mesh with_outlier(Mesh mesh, double far) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const auto out = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(box.lo - (box.hi - box.lo) * far);
  mesh.triangles.push_back({0, 1, out});
  return mesh;
}

Mesh with_crowd(Mesh mesh, std::uint32_t many) {
  const auto crowd = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  mesh.positions.insert(mesh.positions.end(), many, mesh.positions[crowd / 3]);
  for (std::uint32_t i = 0; i < many; ++i) {
    const Triangle t = mesh.triangles[i * 7919ULL % triangles];
    mesh.triangles.push_back({t[0], t[1], crowd + i});
  }
  return mesh;
}

Mesh with_lost_vertices(const Mesh& mesh, std::uint32_t triangles) {
  Mesh made;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    made.positions.push_back(k_no_position);
    made.positions.push_back(mesh.positions[v]);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    made.triangles.push_back({2 * a + 1, 2 * b + 1, 2 * c + 1});
  }
  for (std::uint32_t i = 0; i < triangles; ++i) {
    made.triangles.push_back({2 * i, 2 * i + 1, 2 * i + (i % 2 == 0 ? 3 : 4)});
  }
  return made;
}

Mesh jittered_soup(const Mesh& mesh, double by) {
  std::mt19937 random(1);
  const auto moved = [&](double x) {
    return x + by * (2.0 * static_cast<double>(random()) / std::mt19937::max() - 1);
  };
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) {
      const Vec3 p = mesh.positions[v];
      soup.positions.push_back({moved(p.x), moved(p.y), moved(p.z)});
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

Mesh touching_twice(const Mesh& mesh, Vec3 point) {
  Mesh both = mesh;
  Mesh reflected = mesh;
  for (Vec3& p : reflected.positions) p = point * 2.0 - p;
  for (Triangle& t : reflected.triangles) t = {t[0], t[2], t[1]};
  append(both, reflected);
  return both;
}

std::vector<Appearance> appearances(std::size_t count) {
  std::vector<Appearance> made(count);
  for (std::size_t v = 0; v < count; ++v) {
    made[v] = {static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(v >> 16), 7,
               static_cast<std::uint16_t>(~v)};
  }
  return made;
}

Mesh grid(std::uint32_t nx, std::uint32_t ny) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= ny; ++y) {
    for (std::uint32_t x = 0; x <= nx; ++x) {
      mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), 0});
      if (x == nx || y == ny) continue;
      const std::uint32_t a = y * (nx + 1) + x, b = a + nx + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

Mesh bow_tie() {
  return {{{0, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
}

Mesh three_fans() {
  return {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, -1, 0}, {1, -1, 0}},
          {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
}
}  // namespace meshfarm::test
