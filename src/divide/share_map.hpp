// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

/// Where a batch of vertices goes: as MeshShares::add_vertices() takes it.
struct ShareTargets {
  struct One {
    std::uint32_t share = MeshShares::k_no_share;
    std::uint32_t point = MeshShares::k_no_point;  // vertices of one such number are to be one
  };
  std::vector<std::uint32_t> shares;
  std::vector<std::uint32_t> points;  // or none

  /// Asks for each vertex in order; those without a position go nowhere.
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

/// Divides the vertices of a mesh into shares of about equal size. It is shown all of them as often
/// as it asks for that, and then once more to tell where each goes.
class ShareMap {
 public:
  virtual ~ShareMap() = default;
  /// What it counts vertices by, for people.
  virtual std::string_view name() const = 0;
  /// The next vertices of a scan.
  virtual void count(std::span<const Vec3> batch) = 0;
  /// Ends a scan of all vertices. True if all are to be counted once more.
  virtual bool refine() = 0;
  /// After the last scan: the number of shares.
  virtual std::uint32_t divide() = 0;
  /// Whether there are vertices that are to be one.
  virtual bool merges() const = 0;
  /// To be asked once for each vertex, in order.
  virtual void find_targets(std::span<const Vec3> batch, ShareTargets& targets) = 0;
};

}  // namespace meshfarm
