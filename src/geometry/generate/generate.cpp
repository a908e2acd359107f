// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_shapes.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_min_triangles = 1'000;
constexpr std::uint64_t k_max_triangles = std::uint64_t{1} << 48;

constexpr std::array<std::pair<std::string_view, Shape>, 7> k_names{{{"torus", Shape::torus},
                                                                     {"foam", Shape::foam},
                                                                     {"dust", Shape::dust},
                                                                     {"soup", Shape::soup},
                                                                     {"terrain", Shape::terrain},
                                                                     {"block", Shape::block},
                                                                     {"shell", Shape::shell}}};

}  // namespace

void check_size(std::uint64_t triangles, std::uint64_t least) {
  if (triangles >= least && triangles <= k_max_triangles) return;
  throw UsageError("cannot generate " + std::to_string(triangles) + " triangles: ask for " +
                   std::to_string(least) + " to " + std::to_string(k_max_triangles));
}

Grid nearest_grid(std::uint64_t cells, double shape) {
  const double ideal = std::sqrt(static_cast<double>(cells) / shape);
  const auto middle = static_cast<std::uint64_t>(std::max(6.0, ideal));
  const std::uint64_t reach = std::min<std::uint64_t>(middle / 3 + 1, 2000);
  Grid best;
  std::uint64_t best_miss = ~std::uint64_t{0};
  for (std::uint64_t step = 0; step <= 2 * reach; ++step) {
    const std::uint64_t columns = step % 2 == 0 ? middle + step / 2 : middle - (step + 1) / 2;
    const std::uint64_t rows = (cells + columns / 2) / columns;
    const std::uint64_t miss =
        rows * columns > cells ? rows * columns - cells : cells - rows * columns;
    if (miss < best_miss) {
      best_miss = miss;
      best = {rows, columns};
    }
  }
  return best;
}

Shape shape_named(std::string_view word) {
  std::string known;
  for (const auto& [name, shape] : k_names) {
    if (name == word) return shape;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError("no shape is called " + std::string(word) + ": there are " + known);
}

std::unique_ptr<GeneratedMesh> generate_mesh(Shape shape, std::uint64_t triangles) {
  if (shape == Shape::torus) return std::make_unique<BumpyTorus>(triangles);
  check_size(triangles, k_min_triangles);
  switch (shape) {
    case Shape::foam:
      return make_foam(triangles);
    case Shape::dust:
      return make_dust(triangles);
    case Shape::soup:
      return make_soup(triangles);
    case Shape::terrain:
      return make_terrain(triangles);
    case Shape::block:
      return make_block(triangles);
    default:
      return make_shell(triangles);
  }
}

Mesh in_memory(const GeneratedMesh& generated) {
  if (generated.vertices() > UINT32_MAX) {
    throw UsageError("a mesh of so many triangles cannot be held in memory");
  }
  Mesh mesh;
  generated.for_vertices([&](std::span<const Vec3> batch) {
    mesh.positions.insert(mesh.positions.end(), batch.begin(), batch.end());
  });
  generated.for_triangles([&](std::span<const GeneratedMesh::Corners> batch) {
    for (const auto& [a, b, c] : batch) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                static_cast<std::uint32_t>(c)});
    }
  });
  return mesh;
}

}  // namespace meshfarm
