// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// One rung of a part's ladder: the part when every collapse up to a cost level was made.
struct Rung {
  std::int32_t level = 0;  // rising along the ladder
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;       // falling along the ladder
  std::uint64_t free_triangles = 0;  // those without a locked vertex
  double error = 0;                  // greatest distance from the samples, where it was measured
};

/// What a simplified part tells of itself without being read: travels with the result message.
struct ResultSummary {
  std::vector<Rung> rungs;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
};

std::string encode_summary(const ResultSummary& summary);
ResultSummary decode_summary(std::string_view bytes, std::string_view what);

/// Gathers the rungs of a result, finest first, and makes the staged file.
class ResultEncoder {
 public:
  ResultEncoder(PositionType positions, std::uint32_t boundary_vertices)
      : positions_(positions), boundary_vertices_(boundary_vertices) {}
  void add(std::int32_t level, const Mesh& mesh, std::uint64_t free_triangles, double error = 0);
  /// Points of the part as it came, by which the error of the final mesh is measured.
  void set_samples(SurfaceSamples samples) { samples_ = std::move(samples); }
  bool empty() const { return rungs_.empty(); }
  const std::vector<Rung>& rungs() const { return rungs_; }
  std::string finish() const;

 private:
  PositionType positions_;
  std::uint32_t boundary_vertices_;
  std::vector<Rung> rungs_;
  std::string meshes_;
  SurfaceSamples samples_;
};

/// One rung of a result. The first `boundary_vertices` are the part's, unmoved.
struct ResultMesh {
  Mesh mesh;
  std::uint32_t boundary_vertices = 0;
  SurfaceSamples samples;
};

/// Reads the rung with this index. Throws DataError naming `what`.
ResultMesh decode_result(std::string_view file, std::size_t rung, std::string_view what);

}  // namespace meshfarm
