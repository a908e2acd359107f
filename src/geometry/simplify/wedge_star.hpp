// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

#include "geometry/simplify/collapse_state.hpp"
#include "geometry/simplify/quadric.hpp"

namespace meshfarm {

/// The new texture coordinates on one side of an edge that collapses: the corners at either end
/// that have the old ones get the new ones.
struct WedgeMerge {
  Uv at_a{};
  Uv at_b{};
  Uv now{};
};

/// Rewrites the corners of two vertices that merge.
void merge_wedges(std::span<const WedgeMerge> merges, std::span<const CornerId> at_a,
                  std::span<const CornerId> at_b, std::span<CornerUvs> uvs);

/// Texture coordinates as a linear function over the space around a triangle. Relative to a place
/// on the texture and a point in space.
struct LinearUv {
  std::array<Vec3, 2> slope{};
  std::array<double, 2> at_origin{};
  double weight = 0;  // area; less if too steep; 0 if undefined

  struct Corners {
    Vec3 end, p, q;
    Uv at_end, at_p, at_q;
  };
  /// `scale` is LineOptions::uv_scale.
  static LinearUv of(const Corners& corners, const Uv& base, double scale);
  std::array<double, 2> at(Vec3 x) const {
    return {at_origin[0] + dot(slope[0], x), at_origin[1] + dot(slope[1], x)};
  }
};

/// Weighted sums of such functions, and of their deviations from the mean.
struct LinearUvSums {
  double weight = 0;
  std::array<Vec3, 2> slopes{};
  std::array<double, 2> heights{};
  Quadric squares;
  Vec3 products;  // of slopes and heights
  double squared_heights = 0;

  void add(const LinearUv& uv);
  /// Weight x squared distance from the mean, without linear and constant terms.
  Quadric quadric() const;
  /// Adds the whole, in units of length.
  void add_to(EdgeQuadric& edge, double scale) const;
  std::array<double, 2> mean_at(Vec3 x) const;
};

/// The texture coordinates around one edge, and their values after its collapse. Hoppe, "New
/// Quadric Metric for Simplifying Meshes with Appearance Attributes" (1999): each triangle predicts
/// those of the merged vertex. Inside a chart, it gets the mean of the predictions, weighted by
/// area. On seams and borders, the merged vertex is one of the two ends, on all sides, so that it
/// stays on its line on the texture.
class WedgeStar {
 public:
  enum class End : std::uint8_t { a, b };

  /// Positions are relative to `middle`.
  void list(const CollapseState& state, std::uint32_t a, std::uint32_t b, Vec3 middle);

  /// Whether all corners at each end are one wedge.
  bool is_even() const { return is_even_; }
  /// If both ends are inside a chart: adds the cost of a position.
  void add_to(EdgeQuadric& edge);
  /// If both ends are inside a chart: puts the merged vertex at x. False if refused: a triangle
  /// would be turned over on the texture or lose its area there.
  bool place(Vec3 x);
  /// Puts the merged vertex at one of the ends. False also if the other end has a wedge that is on
  /// neither side.
  bool place_at(End end, Vec3 x);
  /// The cost of the last place_at().
  double cost() const { return cost_; }

  /// For the last placement.
  std::span<const WedgeMerge> merges() const { return merges_; }
  void clear() { merges_.clear(); }

 private:
  struct Facet {
    LinearUv::Corners corners;
    bool at_b;
  };
  struct Side {
    Uv at_a;
    Uv at_b;
  };
  void list_end(const CollapseState& state, std::uint32_t end, std::uint32_t other, bool at_b);
  bool sides_agree(bool at_b) const;
  const Side* side_of(const Uv& wedge, bool at_b) const;

  Vec3 middle_;
  double scale_ = 0;
  bool is_even_ = false;
  double cost_ = 0;
  Uv base_{};
  std::vector<Facet> kept_;
  std::vector<Facet> shared_;
  std::vector<Side> sides_;
  LinearUvSums sums_;
  std::vector<WedgeMerge> merges_;
};

}  // namespace meshfarm
