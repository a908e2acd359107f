// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh_morton.hpp"

namespace meshfarm {

/// The squared distance from `p` to the triangle's nearest point. Degenerate triangles count as the
/// segments or points that they are.
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

/// A bounding volume hierarchy over the triangles of a mesh, four children per node, split along
/// the Morton order of the triangles' centres (Lauterbach et al. 2009); where triangles are
/// stretched along an axis, so is the curve. Up to 20 bytes per triangle, 40 while it is built. The
/// mesh, or its positions and triangles, must outlive it and have finite coordinates.
class Bvh {
 public:
  struct Nearest {
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
  };

  Bvh(const Mesh& mesh, unsigned threads);
  Bvh(std::span<const Vec3> positions, std::span<const Triangle> triangles, unsigned threads);
  /// The indices of the points, which must be finite, sorted along a curve (bvh_morton.hpp), so
  /// that the result for one point is a good guess for the next.
  std::vector<std::uint32_t> search_order(std::span<const Vec3> points) const;
  /// The triangle nearest to `p`, or some triangle whose squared distance is at most `enough`. If
  /// more than a thousand triangles are about equally near, seen from a thousand times as far away
  /// as the mesh is wide, the result may be 1e-6 of the distance farther than the nearest. A good
  /// `guess` saves time.
  Nearest nearest(Vec3 p, std::uint32_t guess, double enough = 0) const;
  /// Some triangle whose squared distance is at most `squared`; infinite if there is none.
  Nearest any_within(Vec3 p, double squared) const;
  /// The least squared distance, as SearchingPoint computes it, if it is less than `squared`;
  /// otherwise `squared`.
  double least_below(Vec3 p, double squared) const;
  /// The nearest triangle whose normal is within 90 degrees of `normal`, if its squared distance is
  /// below `most_squared`; otherwise the squared distance is infinite.
  Nearest nearest_facing(Vec3 p, Vec3 normal, std::uint32_t guess, double most_squared) const;
  /// Among the triangles whose squared distance is `squared`, up to rounding, the normal most
  /// similar to `normal`; from far away only some of them are tried. Zero if none has a normal. Not
  /// of length 1.
  Vec3 most_similar_normal(Vec3 p, Vec3 normal, double squared) const;

  /// Up to six triangles that lie together, and a box round them, in the frame.
  struct Leaf {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::array<float, 3> lo{};
    std::array<float, 3> hi{};
  };
  /// The leaves: each triangle is in exactly one; consecutive leaves are near each other.
  std::vector<Leaf> leaves() const;
  std::span<const std::uint32_t> triangles_of(const Leaf& leaf) const {
    return std::span(order_).subspan(leaf.first, leaf.count);
  }
  /// Adds the leaves whose boxes touch that of `leaf`, including itself. Of two leaves that touch
  /// each other only one finds the other.
  void find_touching(const Leaf& leaf, std::vector<Leaf>& found) const;

 private:
  // Boxes are floats, rounded outwards, in a frame where the box of the mesh (without outliers) is
  // centred and its longest side is between 1/2 and 1: far from the origin, floats could not tell
  // triangles apart.
  struct alignas(64) Node {
    float lo[3][4];
    float hi[3][4];
    std::uint32_t child[4];  // a node; or if count > 0, the first triangle in order_
    std::uint32_t count[4];
  };
  struct Query;

  Vec3 to_frame(Vec3 p) const { return (p - center_) * scale_; }
  /// Clamps to where squares are still floats. No distance grows.
  static Vec3 near_frame(Vec3 in_frame);
  void set_frame_and_curve();
  void make_nodes(unsigned threads);
  Vec3 to_curve(Vec3 in_frame) const;
  Vec3 middle_of(std::uint32_t triangle) const;  // in the frame
  std::vector<MortonItem> sorted_items(unsigned threads) const;
  void split_into_nodes(std::span<const MortonItem> items);
  void set_leaf_boxes(Node& node) const;
  void set_inner_boxes(Node& node) const;
  /// Visits triangles nearest first, until one is near enough. Never looks beyond the query's
  /// initial limit. `distance(triangle)`: the squared distance to use.
  template <class Distance>
  void search(Query& query, double enough, const Distance& distance) const;
  double squared_to(Vec3 p, std::uint32_t triangle) const;
  static Leaf leaf_of(const Node& node, std::size_t k);

  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  Vec3 center_;
  double scale_ = 1;  // a power of two
  // The weight of each axis along the curve: less where triangles are much longer along it than
  // along the others, because splitting it more finely does not separate triangles.
  Vec3 along_curve_{1, 1, 1};
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace meshfarm
