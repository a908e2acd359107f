// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/generate/generate_shapes.hpp"
#include "geometry/generate/generate_torus.hpp"

namespace meshfarm {
namespace {

// The torus is 4 wide and its tube 0.38 thick: 0.0004 between the sheets, where there are no bumps.
constexpr double k_inner_thickness = 1 - 0.0004 / 0.38;

/// A hollow body: the inner sheet faces inwards. Rings of the two sheets alternate.
class Shell : public GeneratedMesh {
 public:
  explicit Shell(std::uint64_t triangles) : grid_(torus_grid(triangles / 4)) {}
  std::uint64_t vertices() const override { return 2 * grid_.rows * grid_.columns; }
  std::uint64_t triangles() const override { return 2 * vertices(); }

  void for_vertices(const TakeVertices& take) const override {
    TorusRings rings(grid_.columns);
    Batches<Vec3> batches(take);
    std::vector<Vec3> both;
    for (std::uint64_t row = 0; row < grid_.rows; ++row) {
      const double turn = static_cast<double>(row) / static_cast<double>(grid_.rows);
      both.clear();
      rings.add_ring(turn, 1, both);
      rings.add_ring(turn, k_inner_thickness, both);
      for (const Vec3& p : both) batches.add(rounded(p, PositionType::float32));
    }
    batches.finish();
  }

  void for_triangles(const TakeTriangles& take) const override {
    Batches<Corners> batches(take);
    const std::uint64_t inner = grid_.columns;
    for (std::uint64_t row = 0; row < grid_.rows; ++row) {
      const std::uint64_t here = 2 * row * grid_.columns;
      const std::uint64_t next = row + 1 < grid_.rows ? here + 2 * grid_.columns : 0;
      for (std::uint64_t i = 0; i < grid_.columns; ++i) {
        const std::uint64_t right = i + 1 < grid_.columns ? i + 1 : 0;
        const std::array<std::uint64_t, 4> cell{here + i, next + i, next + right, here + right};
        add_cell(batches, cell);
        add_cell(batches, {cell[0] + inner, cell[3] + inner, cell[2] + inner, cell[1] + inner});
      }
    }
    batches.finish();
  }

 private:
  Grid grid_;
};

}  // namespace

std::unique_ptr<GeneratedMesh> make_shell(std::uint64_t triangles) {
  return std::make_unique<Shell>(triangles);
}

}  // namespace meshfarm
