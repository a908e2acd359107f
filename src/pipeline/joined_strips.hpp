// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/stitch/stitcher.hpp>

namespace meshfarm {

class SeamTriangles;

/// The strips that concern a group of the seams' surroundings, joined by the triangles between
/// them: those of the input come last.
class JoinedStrips {
 public:
  /// Reads the strips that it joins; the parameters must outlive it.
  JoinedStrips(const SeamParameters& parameters, const JobContext& context);

  const Mesh& mesh() const { return stitched_.mesh; }
  /// Whether it belongs to a component that is left out. The strips have none of it, but triangles
  /// between them may.
  bool is_dropped(const Triangle& t) const {
    return std::any_of(t.begin(), t.end(), [this](std::uint32_t v) { return dropped_[v] != 0; });
  }
  bool is_ours(std::uint32_t vertex) const { return group_[vertex] == parameters_.group; }
  /// How many of the corners are ours.
  int ours_of(const Triangle& t) const {
    return static_cast<int>(
        std::count_if(t.begin(), t.end(), [this](std::uint32_t v) { return is_ours(v); }));
  }
  /// Those of the input.
  std::span<const Triangle> boundary_triangles() const {
    return std::span(mesh().triangles).last(stitched_.boundary_triangles);
  }
  SeamVertex name_of(std::uint32_t vertex) const;
  /// Throws DataError if there is no such vertex, or its strip was not read.
  std::uint32_t vertex_of(const SeamVertex& name) const;
  /// Corners of gaps, in the order of the pieces.
  const std::vector<std::uint32_t>& shared() const { return shared_; }
  PositionType positions() const { return positions_; }

 private:
  struct Strip {
    std::uint32_t first_vertex = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t end_triangle = 0;
  };

  std::uint64_t group_of(std::size_t piece) const {
    return piece * parameters_.groups / parameters_.strips.size();
  }
  void stitch(const JobContext& context, const std::vector<std::uint8_t>& near,
              SeamTriangles& seams);
  void begin_groups();
  void spread(const Strip& strip, std::uint32_t own);

  const SeamParameters& parameters_;
  StitchedMesh stitched_;
  std::vector<Strip> strips_;
  std::vector<std::uint32_t> shared_;
  std::vector<std::uint8_t> dropped_;  // per vertex
  std::vector<std::uint32_t> group_;
  PositionType positions_ = PositionType::float32;
};

}  // namespace meshfarm
