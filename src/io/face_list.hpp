// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "triangle_maker.hpp"

namespace meshfarm {

/// The faces that a thread has read of its piece, to hand them on to a TriangleMaker later, and
/// where their labels change.
class FaceList {
 public:
  void clear() {
    triangles_.clear();
    others_.clear();
    corners_.clear();
  }
  /// Corners are checked.
  void add(std::span<const std::uint64_t> corners) {
    if (corners.size() == 3) {
      triangles_.push_back({corners[0], corners[1], corners[2]});
    } else {
      others_.push_back({.triangles_before = triangles_.size(), .corners = corners.size()});
      corners_.insert(corners_.end(), corners.begin(), corners.end());
    }
  }
  /// Of the faces that follow.
  void label(Label label) {
    others_.push_back({.triangles_before = triangles_.size(), .label = label});
  }
  void play(TriangleMaker& maker) const {
    std::size_t done = 0;
    const std::uint64_t* next = corners_.data();
    for (const Other& face : others_) {
      for (; done < face.triangles_before; ++done) maker.batch().add(triangles_[done]);
      if (face.label) {
        maker.label(*face.label);
        continue;
      }
      maker.begin(CornerOrder::face);
      for (std::size_t i = 0; i < face.corners; ++i) {
        maker.corner(static_cast<std::int64_t>(*next++));
      }
      maker.end();
    }
    for (; done < triangles_.size(); ++done) maker.batch().add(triangles_[done]);
  }

 private:
  struct Other {
    std::size_t triangles_before = 0;
    std::size_t corners = 0;
    std::optional<Label> label = {};  // which is no face then
  };
  std::vector<WideTriangle> triangles_;
  std::vector<Other> others_;
  std::vector<std::uint64_t> corners_;  // of those
};

}  // namespace meshfarm
