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

/// The squared distance from `p` to the triangle's nearest point. Degenerate triangles are the
/// segments or points that they are.
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

/// A bounding volume hierarchy over the triangles of a mesh, four children a node, split along the
/// Morton order of the triangles' centres (Lauterbach et al. 2009); where triangles are stretched
/// along an axis, so is the curve. Up to 20 bytes a triangle, 40 while it is built. The mesh, or
/// its positions and triangles, must outlive it and have finite coordinates.
class Bvh {
 public:
  struct Nearest {
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
  };

  Bvh(const Mesh& mesh, unsigned threads);
  Bvh(std::span<const Vec3> positions, std::span<const Triangle> triangles, unsigned threads);
  /// The numbers of the points, which must be finite, along a curve (bvh_morton.hpp): what one
  /// finds is a good guess for the next.
  std::vector<std::uint32_t> search_order(std::span<const Vec3> points) const;
  /// The triangle nearest to `p`, or some triangle whose squared distance is at most `enough`. Of
  /// more than a thousand that are as near, seen from a thousand times as far away as the mesh is
  /// wide, it may be one that is 1e-6 of the distance farther. A good `guess` saves time.
  Nearest nearest(Vec3 p, std::uint32_t guess, double enough = 0) const;
  /// Some triangle whose squared distance is at most `squared`; infinite if there is none.
  Nearest any_within(Vec3 p, double squared) const;
  /// The least squared distance as SearchingPoint counts it, if it is less than `squared`; else
  /// that.
  double least_below(Vec3 p, double squared) const;
  /// The nearest of the triangles whose normals are within 90 degrees of `normal`, if one is nearer
  /// than the root of `most_squared`; else its squared distance is infinite.
  Nearest nearest_facing(Vec3 p, Vec3 normal, std::uint32_t guess, double most_squared) const;
  /// Of the normals of all triangles whose squared distance is `squared`, but for rounding, the one
  /// that is most like `normal`, from far away of some of them; zero if none has one. Not of
  /// length 1.
  Vec3 most_similar_normal(Vec3 p, Vec3 normal, double squared) const;

  /// Up to six triangles that lie together, and a box round them in the frame.
  struct Leaf {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::array<float, 3> lo{};
    std::array<float, 3> hi{};
  };
  /// All triangles, each in one leaf; leaves side by side are near each other.
  std::vector<Leaf> leaves() const;
  std::span<const std::uint32_t> triangles_of(const Leaf& leaf) const {
    return std::span(order_).subspan(leaf.first, leaf.count);
  }
  /// Adds the leaves whose boxes touch that of `leaf`: itself, and of two that touch each other
  /// only one finds the other.
  void find_touching(const Leaf& leaf, std::vector<Leaf>& found) const;

 private:
  // Boxes are floats, rounded outwards, in a frame where the box of the mesh, without outliers, is
  // centred and its longest side between 1/2 and 1: far from the origin floats could not tell
  // triangles apart.
  struct alignas(64) Node {
    float lo[3][4];
    float hi[3][4];
    std::uint32_t child[4];  // a node, or where count > 0 the first of so many triangles of order_
    std::uint32_t count[4];
  };
  struct Query;

  Vec3 to_frame(Vec3 p) const { return (p - center_) * scale_; }
  /// Where squares are still floats. Nothing comes to lie farther from anything else than it was.
  static Vec3 near_frame(Vec3 in_frame);
  void set_frame_and_curve();
  void make_nodes(unsigned threads);
  Vec3 to_curve(Vec3 in_frame) const;
  Vec3 middle_of(std::uint32_t triangle) const;  // in the frame
  std::vector<MortonItem> sorted_items(unsigned threads) const;
  void split_into_nodes(std::span<const MortonItem> items);
  void set_leaf_boxes(Node& node) const;
  void set_inner_boxes(Node& node) const;
  /// Nearest first, until what was found is near enough. What is farther than the query's limit at
  /// the begin is never looked at. `distance(triangle)`: what counts of one, squared.
  template <class Distance>
  void search(Query& query, double enough, const Distance& distance) const;
  double squared_to(Vec3 p, std::uint32_t triangle) const;
  static Leaf leaf_of(const Node& node, std::size_t k);

  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  Vec3 center_;
  double scale_ = 1;  // a power of two
  // What each axis counts along the curve: less where triangles are much longer in it than in the
  // others, as splitting it more finely than that tells no triangles apart.
  Vec3 along_curve_{1, 1, 1};
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace meshfarm
