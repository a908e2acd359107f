// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_noise.hpp"
#include "geometry/generate/generate_shapes.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_terrain_noise = 200;  // separate random numbers
constexpr std::uint64_t k_first_cells = 4;
constexpr std::uint64_t k_last_cells = 4096;
constexpr double k_part = 0.9;     // of the noise that is used, because it is periodic
constexpr double k_height = 0.25;  // of the first octave; the ground is 1 x 1
constexpr double k_fade = 0.45;    // from one octave to the next
constexpr double k_lake = 0.24;    // its level

/// Ridged noise (Musgrave 1994): |n| folds each octave into ridges; low ground becomes lakes. There
/// are as many octaves as the grid can resolve.
class Terrain : public GeneratedMesh {
 public:
  explicit Terrain(std::uint64_t triangles) : grid_(nearest_grid(triangles / 2, 1)) {}
  std::uint64_t vertices() const override { return (grid_.rows + 1) * (grid_.columns + 1); }
  std::uint64_t triangles() const override { return 2 * grid_.rows * grid_.columns; }

  void for_vertices(const TakeVertices& take) const override {
    std::vector<NoiseRow> octaves;
    for (std::uint64_t cells = k_first_cells;
         cells <= k_last_cells && 2 * cells <= std::min(grid_.rows, grid_.columns); cells *= 2) {
      octaves.emplace_back(k_terrain_noise + octaves.size(), cells, cells);
    }
    Batches<Vec3> batches(take);
    for (std::uint64_t row = 0; row <= grid_.rows; ++row) {
      const double y = static_cast<double>(row) / static_cast<double>(grid_.rows);
      for (NoiseRow& octave : octaves) octave.set_row(k_part * y);
      for (std::uint64_t i = 0; i <= grid_.columns; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(grid_.columns);
        batches.add(rounded({x, y, height(octaves, x)}, PositionType::float32));
      }
    }
    batches.finish();
  }

  void for_triangles(const TakeTriangles& take) const override {
    Batches<Corners> batches(take);
    const std::uint64_t width = grid_.columns + 1;
    for (std::uint64_t row = 0; row < grid_.rows; ++row) {
      for (std::uint64_t i = 0; i < grid_.columns; ++i) {
        const std::uint64_t here = row * width + i;
        add_cell(batches, {here, here + 1, here + width + 1, here + width});
      }
    }
    batches.finish();
  }

 private:
  static double height(const std::vector<NoiseRow>& octaves, double x) {
    double sum = 0, share = k_height;
    for (const NoiseRow& octave : octaves) {
      sum += share * (1 - std::fabs(octave(k_part * x)));
      share *= k_fade;
    }
    return std::max(sum, k_lake) - k_lake;
  }

  Grid grid_;
};

}  // namespace

std::unique_ptr<GeneratedMesh> make_terrain(std::uint64_t triangles) {
  return std::make_unique<Terrain>(triangles);
}

}  // namespace meshfarm
