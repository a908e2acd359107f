// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The level set of a sum of plane waves of about equal length (a spinodal foam: Cahn 1965), cut out
// by a box. Marching tetrahedra (Doi, Koide 1991; six per cell, after Kuhn) process it layer by
// layer; the surface is closed and manifold for any values.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_noise.hpp"
#include "geometry/generate/generate_shapes.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_foam_noise = 300;  // separate random numbers
constexpr std::uint64_t k_waves = 24;
constexpr double k_wave_length = 6;  // in cells
constexpr double k_band = 0.15;      // relative spread of wave lengths
constexpr double k_foam_cell = 0x1p-3;
constexpr double k_in_a_cell = 3.6;  // triangles, about
// The box is a cube up to this width, so that layers fit into memory; beyond that it grows longer.
constexpr std::uint64_t k_min_width = 6, k_max_width = 512;
// Values are clamped to this, so that the box's walls, with the least value, are flat inside the
// foam and meet its surface without steps.
constexpr double k_most = 3;
constexpr double k_least_share = 0.05;  // least share of an edge between vertex and end

/// A direction from one corner of a cell to another is three bits: 1 is x, 2 is y, 4 is z.
/// Directions of edges within a layer come before those that leave it.
using Direction = unsigned;
constexpr Direction k_flat_directions = 3, k_directions = 7;

/// The even permutation of a tetrahedron's corners that puts those in the set first; sets of three
/// use that of their complement.
constexpr std::array<std::array<unsigned, 4>, 16> k_order{{{},
                                                           {0, 1, 2, 3},
                                                           {1, 0, 3, 2},
                                                           {0, 1, 2, 3},
                                                           {2, 3, 0, 1},
                                                           {0, 2, 3, 1},
                                                           {1, 2, 0, 3},
                                                           {3, 2, 1, 0},
                                                           {3, 2, 1, 0},
                                                           {0, 3, 1, 2},
                                                           {1, 3, 2, 0},
                                                           {2, 3, 0, 1},
                                                           {2, 3, 0, 1},
                                                           {1, 0, 3, 2},
                                                           {0, 1, 2, 3},
                                                           {}}};

/// The tetrahedra of a cell: each runs from corner 0 to corner 7 along the axes in a different
/// order. All have the same orientation.
constexpr std::array<std::array<Direction, 4>, 6> k_tetrahedra{
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};

struct Wave {
  Vec3 turns;  // along each axis, per cell
  double phase = 0;
};

std::vector<Wave> make_waves() {
  std::vector<Wave> waves;
  for (std::uint64_t call = 0; waves.size() < k_waves; ++call) {
    const auto random = [&](std::uint64_t what) { return lattice_value(k_foam_noise, call, what); };
    const Vec3 p{random(0), random(1), random(2)};
    const double reach = length(p);
    if (reach < 0.1 || reach > 1) continue;  // evenly in all directions
    const double turns = (1 + k_band * random(3)) / k_wave_length;
    waves.push_back({p * (turns / reach), (random(4) + 1) / 2});
  }
  return waves;
}

Circle at_phase(double turns) {
  return on_circle(turns - std::floor(turns));
}

/// The values at the points of one layer after another.
class Field {
 public:
  explicit Field(std::uint64_t width) : width_(width), waves_(make_waves()) {
    for (const Wave& wave : waves_) {
      for (std::uint64_t x = 0; x <= width_; ++x) {
        along_x_.push_back(at_phase(wave.turns.x * static_cast<double>(x)));
      }
    }
  }

  /// Positive inside the foam.
  void fill(std::uint64_t layer, std::vector<double>& values) const {
    values.assign((width_ + 1) * (width_ + 1), -k_most);
    for (std::uint64_t y = 1; y < width_; ++y) {
      double* row = &values[y * (width_ + 1)];
      std::fill(row + 1, row + width_, 0.0);
      for (std::size_t w = 0; w < waves_.size(); ++w) {
        const Wave& wave = waves_[w];
        const Circle at = at_phase(wave.turns.y * static_cast<double>(y) +
                                   wave.turns.z * static_cast<double>(layer) + wave.phase);
        const Circle* along = &along_x_[w * (width_ + 1)];
        for (std::uint64_t x = 1; x < width_; ++x) {
          row[x] += at.cos * along[x].cos - at.sin * along[x].sin;
        }
      }
      for (std::uint64_t x = 1; x < width_; ++x) row[x] = std::clamp(row[x], -k_most, k_most);
    }
  }

 private:
  std::uint64_t width_;
  std::vector<Wave> waves_;
  std::vector<Circle> along_x_;
};

/// The edges in one direction group (in a layer, or from it to the next) that cross the surface.
struct Crossings {
  std::vector<std::uint64_t> first;  // vertex of each point's first crossing
  std::vector<std::uint8_t> set;     // one bit per direction

  std::uint64_t vertex(std::uint64_t point, Direction d) const {
    return first[point] + static_cast<std::uint64_t>(std::popcount(set[point] & ((1U << d) - 1)));
  }
};

struct Layer {
  std::vector<double> values;
  Crossings flat;
};

struct Counts {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};

/// Where the surface crosses an edge, from the end with value `a` to that with `b`.
double share_at(double a, double b) {
  return std::clamp(a / (a - b), k_least_share, 1 - k_least_share);
}

/// Goes through the foam from its bottom: two layers of points, and the cells between.
class Sweep {
 public:
  using AddVertex = std::function<void(Vec3)>;
  using AddTriangle = std::function<void(const GeneratedMesh::Corners&)>;

  explicit Sweep(std::uint64_t width, AddVertex add_vertex = {}, AddTriangle add_triangle = {})
      : width_(width),
        field_(width),
        add_vertex_(std::move(add_vertex)),
        add_triangle_(std::move(add_triangle)) {
    lower_.values.assign((width_ + 1) * (width_ + 1), -k_most);
    find_flat(lower_);
  }

  /// Moves up one layer; `last`: to the box's wall.
  void step(bool last) {
    if (last) {
      upper_.values.assign(lower_.values.size(), -k_most);
    } else {
      field_.fill(layer_ + 1, upper_.values);
    }
    cross_up();
    ++layer_;
    find_flat(upper_);
    for (std::uint64_t y = 0; y < width_; ++y) {
      for (std::uint64_t x = 0; x < width_; ++x) add_cell(y * (width_ + 1) + x);
    }
    std::swap(lower_, upper_);
  }
  /// Vertices and triangles below the current layer.
  const Counts& counts() const { return counts_; }

 private:
  std::uint64_t offset(Direction d) const { return (d & 1) + (d >> 1 & 1) * (width_ + 1); }
  double value(std::uint64_t point, Direction d) const {
    return (d < 4 ? lower_ : upper_).values[point + offset(d)];
  }

  void find_flat(Layer& layer) {
    const auto& values = layer.values;
    const auto value = [&](std::uint64_t p, Direction d) { return values[p + offset(d)]; };
    find(layer.flat, 1, k_flat_directions, values, value);
  }
  void cross_up() {
    const auto upper = [&](std::uint64_t p, Direction d) { return value(p, d); };
    find(up_, k_flat_directions + 1, k_directions, lower_.values, upper);
  }
  /// Makes the vertices of the edges in directions `from` to `to`.
  template <class Value>
  void find(Crossings& out, Direction from, Direction to, const std::vector<double>& values,
            const Value& value) {
    out.first.assign(values.size(), 0);
    out.set.assign(values.size(), 0);
    // Edges that begin on the outermost points lead out of the box or along its wall.
    for (std::uint64_t y = 0; y < width_; ++y) {
      for (std::uint64_t x = 0; x < width_; ++x) {
        const std::uint64_t p = y * (width_ + 1) + x;
        out.first[p] = counts_.vertices;
        for (Direction d = from; d <= to; ++d) {
          const double a = values[p], b = value(p, d);
          if ((a > 0) == (b > 0)) continue;
          out.set[p] |= static_cast<std::uint8_t>(1U << d);
          ++counts_.vertices;
          if (add_vertex_) add_vertex_(place({x, y}, d, share_at(a, b)));
        }
      }
    }
  }
  Vec3 place(std::array<std::uint64_t, 2> at, Direction d, double share) const {
    const auto along = [&](std::uint64_t start, Direction bit) {
      return (static_cast<double>(start) + ((d & bit) != 0 ? share : 0)) * k_foam_cell;
    };
    return {along(at[0], 1), along(at[1], 2), along(layer_, 4)};
  }

  /// The vertex between two corners of the cell at `point`, where an edge leads from one to the
  /// other.
  std::uint64_t vertex(std::uint64_t point, Direction a, Direction b) const {
    const Direction start = a & b, d = a ^ b;
    const std::uint64_t p = point + offset(start);
    if (d > k_flat_directions) return up_.vertex(p, d);
    return (start < 4 ? lower_ : upper_).flat.vertex(p, d);
  }
  void add_cell(std::uint64_t point) {
    unsigned inside = 0;
    for (Direction d = 0; d < 8; ++d) inside |= static_cast<unsigned>(value(point, d) > 0) << d;
    if (inside == 0 || inside == 0xff) return;
    for (const auto& corners : k_tetrahedra) add_tetrahedron(point, corners, inside);
  }
  void add_tetrahedron(std::uint64_t point, const std::array<Direction, 4>& corners,
                       unsigned cell_inside) {
    unsigned inside = 0;
    for (unsigned k = 0; k < 4; ++k) inside |= (cell_inside >> corners[k] & 1) << k;
    if (inside == 0 || inside == 0xf) return;
    const auto& order = k_order[inside];
    const auto at = [&](unsigned a, unsigned b) {
      return vertex(point, corners[order[a]], corners[order[b]]);
    };
    switch (std::popcount(inside)) {
      case 1:
        return add({at(0, 1), at(0, 2), at(0, 3)});
      case 2:
        add({at(0, 2), at(0, 3), at(1, 3)});
        return add({at(0, 2), at(1, 3), at(1, 2)});
      default:
        return add({at(0, 1), at(0, 3), at(0, 2)});
    }
  }
  void add(const GeneratedMesh::Corners& corners) {
    ++counts_.triangles;
    if (add_triangle_) add_triangle_(corners);
  }

  std::uint64_t width_;
  Field field_;
  AddVertex add_vertex_;
  AddTriangle add_triangle_;
  std::uint64_t layer_ = 0;
  Layer lower_, upper_;
  Crossings up_;
  Counts counts_;
};

class Foam : public GeneratedMesh {
 public:
  explicit Foam(std::uint64_t triangles) {
    const double cells = static_cast<double>(triangles) / k_in_a_cell;
    width_ = k_min_width;
    while (width_ < k_max_width &&
           static_cast<double>((width_ + 1) * (width_ + 1) * (width_ + 1)) <= cells)
      ++width_;
    find_height(triangles);
  }
  std::uint64_t vertices() const override { return counts_.vertices; }
  std::uint64_t triangles() const override { return counts_.triangles; }

  void for_vertices(const TakeVertices& take) const override {
    Batches<Vec3> batches(take);
    run(Sweep(width_, [&](Vec3 p) { batches.add(rounded(p, PositionType::float32)); }));
    batches.finish();
  }
  void for_triangles(const TakeTriangles& take) const override {
    Batches<Corners> batches(take);
    run(Sweep(width_, {}, [&](const Corners& corners) { batches.add(corners); }));
    batches.finish();
  }

 private:
  /// Finds the number of layers that comes nearest to the number of triangles.
  void find_height(std::uint64_t triangles) {
    Sweep open(width_);
    std::uint64_t before = 0;
    for (std::uint64_t layers = 1;; ++layers) {
      open.step(false);
      Sweep closed = open;
      closed.step(true);
      const Counts counts = closed.counts();
      const bool enough = counts.triangles >= triangles;
      if (enough && layers > 1 && triangles - before < counts.triangles - triangles) return;
      height_ = layers;
      counts_ = counts;
      if (enough) return;
      before = counts.triangles;
    }
  }
  Counts run(Sweep sweep) const {
    for (std::uint64_t layer = 0; layer < height_; ++layer) sweep.step(false);
    sweep.step(true);
    return sweep.counts();
  }

  std::uint64_t width_ = 0;
  std::uint64_t height_ = 0;  // layers of points inside the box
  Counts counts_;
};

}  // namespace

std::unique_ptr<GeneratedMesh> make_foam(std::uint64_t triangles) {
  return std::make_unique<Foam>(triangles);
}

}  // namespace meshfarm
