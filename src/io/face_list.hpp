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

/// The faces that a thread has read from its piece, kept for a TriangleMaker, and where their
/// labels change.
class FaceList {
 public:
  void clear() {
    triangles_.clear();
    others_.clear();
    corners_.clear();
    uvs_.clear();
    corner_uvs_.clear();
  }
  /// The corners must be valid. Either all faces have texture coordinates, one per corner, or none
  /// has.
  void add(std::span<const std::uint64_t> corners, std::span<const Uv> uvs = {}) {
    if (corners.size() == 3) {
      if (!uvs.empty()) uvs_.push_back({uvs[0], uvs[1], uvs[2]});
      triangles_.push_back({corners[0], corners[1], corners[2]});
    } else {
      others_.push_back({.triangles_before = triangles_.size(), .corners = corners.size()});
      corners_.insert(corners_.end(), corners.begin(), corners.end());
      corner_uvs_.insert(corner_uvs_.end(), uvs.begin(), uvs.end());
    }
  }
  /// The label of the faces that follow.
  void label(Label label) {
    others_.push_back({.triangles_before = triangles_.size(), .label = label});
  }
  void play(TriangleMaker& maker) const {
    std::size_t done = 0;
    std::size_t next = 0;
    for (const Other& face : others_) {
      play_triangles(done, face.triangles_before, maker.batch());
      done = face.triangles_before;
      if (face.label) {
        maker.label(*face.label);
        continue;
      }
      maker.begin(CornerOrder::face);
      if (!corner_uvs_.empty()) maker.uvs(std::span(corner_uvs_).subspan(next, face.corners));
      for (std::size_t i = 0; i < face.corners; ++i) {
        maker.corner(static_cast<std::int64_t>(corners_[next++]));
      }
      maker.end();
    }
    play_triangles(done, triangles_.size(), maker.batch());
  }

 private:
  struct Other {
    std::size_t triangles_before = 0;
    std::size_t corners = 0;
    std::optional<Label> label = {};  // if set, this is no face
  };
  void play_triangles(std::size_t first, std::size_t end, TriangleBatch& batch) const {
    if (uvs_.empty()) {
      for (std::size_t i = first; i < end; ++i) batch.add(triangles_[i]);
    } else {
      for (std::size_t i = first; i < end; ++i) batch.add(triangles_[i], uvs_[i]);
    }
  }

  std::vector<WideTriangle> triangles_;
  std::vector<Other> others_;
  std::vector<std::uint64_t> corners_;  // of the others
  std::vector<CornerUvs> uvs_;          // of the triangles
  std::vector<Uv> corner_uvs_;          // of the corners of the others
};

}  // namespace meshfarm
