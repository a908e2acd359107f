// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include "geometry/generate/generate_shapes.hpp"
#include "geometry/generate/generate_torus.hpp"

namespace meshfarm {
namespace {

// Corners are moved away from those of neighbouring triangles; otherwise a weld would join them
// again.
constexpr double k_shrink = 0.98;

/// Every triangle with three vertices of its own.
class Soup : public GeneratedMesh {
 public:
  explicit Soup(std::uint64_t triangles) : grid_(torus_grid(triangles / 2)) {}
  std::uint64_t vertices() const override { return 3 * triangles(); }
  std::uint64_t triangles() const override { return 2 * grid_.rows * grid_.columns; }

  void for_vertices(const TakeVertices& take) const override {
    TorusRings rings(grid_.columns);
    Batches<Vec3> batches(take);
    std::vector<Vec3> here, next;
    rings.add_ring(0, 1, here);
    for (std::uint64_t row = 0; row < grid_.rows; ++row) {
      const std::uint64_t below = row + 1 < grid_.rows ? row + 1 : 0;
      next.clear();
      rings.add_ring(static_cast<double>(below) / static_cast<double>(grid_.rows), 1, next);
      for (std::uint64_t i = 0; i < grid_.columns; ++i) {
        const std::uint64_t right = i + 1 < grid_.columns ? i + 1 : 0;
        add(batches, here[i], next[i], next[right]);
        add(batches, here[i], next[right], here[right]);
      }
      std::swap(here, next);
    }
    batches.finish();
  }

  void for_triangles(const TakeTriangles& take) const override {
    Batches<Corners> batches(take);
    for (std::uint64_t v = 0; v < vertices(); v += 3) batches.add({v, v + 1, v + 2});
    batches.finish();
  }

 private:
  static void add(Batches<Vec3>& batches, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 middle = (a + b + c) * (1.0 / 3);
    for (const Vec3& p : {a, b, c}) {
      batches.add(rounded(middle + (p - middle) * k_shrink, PositionType::float32));
    }
  }

  Grid grid_;
};

}  // namespace

std::unique_ptr<GeneratedMesh> make_soup(std::uint64_t triangles) {
  return std::make_unique<Soup>(triangles);
}

}  // namespace meshfarm
