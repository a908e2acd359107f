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
  std::size_t channels = 1;  // values per point
  /// About how many points will be added. If there are many per triangle, only a share of them is
  /// used, chosen by their numbers: more points add little.
  std::uint64_t points = 0;
  unsigned threads = 0;  // 0: one per core
};

/// Computes vertex values such that the mesh, interpolating them linearly over each triangle,
/// approximates values known at points round it, in the least squares' sense. For colours, these
/// points are on the surface that the mesh was simplified from. Several values per point, each
/// fitted independently. The result does not depend on the threads. Memory: 50 bytes per triangle,
/// and 24 for each value; 30 for each vertex and value at the end.
class ChannelFit {
 public:
  /// `mesh` must outlive it and have finite coordinates and at least one triangle.
  ChannelFit(const Mesh& mesh, const ChannelFitOptions& options);
  ~ChannelFit();
  ChannelFit(ChannelFit&&) noexcept;

  /// Adds points and their values, `channels` consecutive values per point. A point counts for its
  /// nearest triangle, or for one that is hardly farther: the same calls give the same values.
  /// Points near each other are best added together.
  void add(std::span<const Vec3> points, std::span<const float> values);
  /// The values of the vertices, `channels` consecutive values per vertex. A vertex without points
  /// near it takes the values of its neighbours.
  std::vector<float> values() const;
  /// By how much the mesh with these values, as returned by values(), misses the points' values:
  /// the root mean square of each channel. Zeros if there were no points.
  std::vector<double> rms(std::span<const float> values) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The corners' shares at the triangle's point nearest to `p`: not negative, sum 1.
std::array<double, 3> nearest_shares(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace meshfarm
