// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_noise.hpp"
#include "geometry/generate/generate_shapes.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_dust_noise = 100;  // separate random numbers
constexpr std::array<std::array<std::uint64_t, 3>, 8> k_faces{
    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
constexpr std::uint64_t k_corners = 6;

// Specks float in this box, clear of the tube.
constexpr Vec3 k_box{1.5, 1.5, 0.6};
constexpr double k_clear_of_ring = 0.6;
constexpr double k_largest = 0.02;
constexpr int k_size_halvings = 6;  // from the largest specks to the smallest

/// A crooked octahedron.
class Speck {
 public:
  explicit Speck(std::uint64_t number) : number_(number) {
    do {
      centre_ = {random() * k_box.x, random() * k_box.y, random() * k_box.z};
    } while (from_ring() < k_clear_of_ring);
    size_ = k_largest * (0.75 + 0.25 * random());
    const double halvings = (random() + 1) / 2 * k_size_halvings;
    for (int i = 0; i < static_cast<int>(halvings); ++i) size_ *= 0.5;
  }

  Vec3 corner(std::uint64_t corner) {
    const double reach = size_ * (0.75 + 0.25 * random()) * (corner % 2 == 0 ? 1 : -1);
    Vec3 p = centre_;
    (corner < 2 ? p.x : corner < 4 ? p.y : p.z) += reach;
    return rounded(p, PositionType::float32);
  }

 private:
  double random() { return lattice_value(k_dust_noise, number_, ++calls_); }
  double from_ring() const {
    const double out = std::sqrt(centre_.x * centre_.x + centre_.y * centre_.y) - 1;
    return std::sqrt(out * out + centre_.z * centre_.z);
  }

  std::uint64_t number_;
  std::uint64_t calls_ = 0;
  Vec3 centre_;
  double size_ = 0;
};

/// The surface, then the specks.
class Dust : public GeneratedMesh {
 public:
  explicit Dust(std::uint64_t triangles)
      : surface_(triangles / 4 * 3),
        specks_((triangles - std::min(triangles, surface_.triangles())) / k_faces.size()) {}
  std::uint64_t vertices() const override { return surface_.vertices() + specks_ * k_corners; }
  std::uint64_t triangles() const override {
    return surface_.triangles() + specks_ * k_faces.size();
  }

  void for_vertices(const TakeVertices& take) const override {
    surface_.for_vertices(take);
    Batches<Vec3> batches(take);
    for (std::uint64_t number = 0; number < specks_; ++number) {
      Speck speck(number);
      for (std::uint64_t i = 0; i < k_corners; ++i) batches.add(speck.corner(i));
    }
    batches.finish();
  }

  void for_triangles(const TakeTriangles& take) const override {
    surface_.for_triangles(take);
    Batches<Corners> batches(take);
    for (std::uint64_t number = 0; number < specks_; ++number) {
      const std::uint64_t first = surface_.vertices() + number * k_corners;
      for (const auto& [a, b, c] : k_faces) batches.add({first + a, first + b, first + c});
    }
    batches.finish();
  }

 private:
  BumpyTorus surface_;
  std::uint64_t specks_;
};

}  // namespace

std::unique_ptr<GeneratedMesh> make_dust(std::uint64_t triangles) {
  return std::make_unique<Dust>(triangles);
}

}  // namespace meshfarm
