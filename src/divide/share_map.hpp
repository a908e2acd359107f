// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

/// The targets of a batch of vertices, in the form for MeshShares::add_vertices().
struct ShareTargets {
  struct One {
    std::uint32_t share = MeshShares::k_no_share;
    std::uint32_t point = MeshShares::k_no_point;  // vertices with the same number are merged
  };
  std::vector<std::uint32_t> shares;
  std::vector<std::uint32_t> points;  // empty if there are none

  /// Calls `target_of` for each vertex in order; those without a position get no share.
  template <class TargetOf>
  void fill(std::span<const Vec3> batch, bool with_points, const TargetOf& target_of) {
    shares.clear();
    points.clear();
    for (const Vec3& p : batch) {
      const One target = has_position(p) ? target_of(p) : One{};
      shares.push_back(target.share);
      if (with_points) points.push_back(target.point);
    }
  }
};

/// Divides the vertices of a mesh into shares of about equal size. All vertices are shown to it as
/// often as it asks for that, and then once more to get their shares.
class ShareMap {
 public:
  virtual ~ShareMap() = default;
  /// What vertices are counted by, for messages.
  virtual std::string_view name() const = 0;
  /// The next vertices of a scan.
  virtual void count(std::span<const Vec3> batch) = 0;
  /// Ends a scan of all vertices. Returns true if all must be counted again.
  virtual bool refine() = 0;
  /// Call this after the last scan. Returns the number of shares.
  virtual std::uint32_t divide() = 0;
  /// Whether some vertices are to be merged.
  virtual bool merges() const = 0;
  /// Call this once for each vertex, in order.
  virtual void find_targets(std::span<const Vec3> batch, ShareTargets& targets) = 0;
};

}  // namespace meshfarm
