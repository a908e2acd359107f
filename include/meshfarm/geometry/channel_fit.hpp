// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct ChannelFitOptions {
  std::size_t channels = 1;  // values a point
  /// How many points will come, about. Where they are many for each triangle, a share of them is
  /// taken, chosen by their numbers: more tell little more.
  std::uint64_t points = 0;
  unsigned threads = 0;  // 0: one a core
};

/// Gives the vertices of a mesh values such that the mesh, where it blends them linearly over each
/// triangle, is as near as can be (in the least squares' sense) to values that are known at points
/// round it: of colours, the ones of the surface that the mesh was simplified from. Several values
/// a point, each fitted by itself. The result does not depend on the threads.
/// Memory: 50 bytes a triangle, and 24 for each value; 30 for each vertex and value at the end.
class ChannelFit {
 public:
  /// `mesh` must outlive it and have finite coordinates and at least one triangle.
  ChannelFit(const Mesh& mesh, const ChannelFitOptions& options);
  ~ChannelFit();
  ChannelFit(ChannelFit&&) noexcept;

  /// Takes points and their values, `channels` of each point one after the other. A point counts
  /// for the triangle that it is nearest to, or for one that is hardly farther: the same calls give
  /// the same values. Points near each other are best given together.
  void add(std::span<const Vec3> points, std::span<const float> values);
  /// The values of the vertices, `channels` of each vertex one after the other. A vertex that no
  /// point tells of has those of its neighbours.
  std::vector<float> values() const;
  /// By how much the mesh with these values, as values() had them, misses the points' values: the
  /// root mean square of each channel. Zeros if there were no points.
  std::vector<double> rms(std::span<const float> values) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The corners' shares in the triangle's point nearest to `p`: not negative, 1 together.
std::array<double, 3> nearest_shares(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace meshfarm
