// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A procedural mesh of any size, made piece by piece: at most a row of its grid is held in memory,
/// or, for foam, a layer of at most 512 x 512 cells. The same bytes on every machine. Coordinates
/// are exact floats.
class GeneratedMesh {
 public:
  using Corners = std::array<std::uint64_t, 3>;
  using TakeVertices = std::function<void(std::span<const Vec3>)>;
  using TakeTriangles = std::function<void(std::span<const Corners>)>;

  virtual ~GeneratedMesh() = default;
  virtual std::uint64_t vertices() const = 0;
  virtual std::uint64_t triangles() const = 0;
  /// Calls `take` with batches, in order; likewise for triangles.
  virtual void for_vertices(const TakeVertices& take) const = 0;
  virtual void for_triangles(const TakeTriangles& take) const = 0;
};

enum class Shape {
  torus,    // BumpyTorus
  foam,     // level set of band-limited noise: closed, its genus in proportion to its size
  dust,     // the torus in a cloud of closed specks, a quarter of all triangles
  soup,     // the torus as single triangles: no two share a vertex or a point
  terrain,  // height field of fractal noise with flat lakes: one sheet with one border
  block,  // machined plate with six counterbored holes and fillets: closed, flat faces, sharp edges
  shell   // the torus twice, one inside the other, a ten-thousandth of its size apart: closed
};

/// Throws UsageError, which lists the names, if `word` is not one of them.
Shape shape_named(std::string_view word);

/// Has about `triangles` triangles: within 3 % from 10,000 on. Throws UsageError for fewer than
/// 1,000 (torus: 200) or more than 2^48. Foam is generated once just to count its triangles.
std::unique_ptr<GeneratedMesh> generate_mesh(Shape shape, std::uint64_t triangles);

/// The whole mesh. Throws UsageError if it has more vertices than a Mesh can index.
Mesh in_memory(const GeneratedMesh& generated);

/// A torus with bumps of several octaves and flat stretches, so that neighbouring regions deserve
/// very different numbers of triangles. Closed, oriented, one component, Euler characteristic 0.
class BumpyTorus : public GeneratedMesh {
 public:
  /// The number of triangles, 2 * rows * columns, is the nearest that a grid of well-shaped
  /// triangles can have. Throws UsageError below 200 triangles and above 2^48.
  explicit BumpyTorus(std::uint64_t triangles);
  std::uint64_t vertices() const override { return rows_ * columns_; }
  std::uint64_t triangles() const override { return 2 * rows_ * columns_; }
  void for_vertices(const TakeVertices& take) const override;
  void for_triangles(const TakeTriangles& take) const override;

 private:
  std::uint64_t rows_ = 0;
  std::uint64_t columns_ = 0;
};

/// Puts vertices and triangles into a random order that depends on `seed` alone, and turns the
/// triangles: the same surface, with no locality left.
void shuffle(Mesh& mesh, std::uint64_t seed);

}  // namespace meshfarm
