// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/stitch/stitcher.hpp>

namespace meshfarm {

/// The triangles of a piece between its mesh and the surroundings of the seams, or of a group of
/// these between its mesh and other groups. Corners are the mesh's shared vertices, followed by
/// those of groups, whose positions are stored here.
struct PieceGap {
  std::vector<Vec3> positions;
  std::vector<SeamVertex> vertices;  // the names of these vertices
  std::vector<Triangle> triangles;
  TriangleColumns columns;  // of these
};
std::string encode_gap(const PieceGap& gap);
PieceGap decode_gap(std::string_view bytes, std::string_view what);

/// What a piece gives to the surroundings of the seams.
struct PieceStrip {
  ResultMesh mesh;                    // its boundary vertices are the piece's
  std::vector<std::uint32_t> shared;  // vertices in the gap, in its order
  /// Boundary vertices of components that are left out, ascending.
  std::vector<std::uint32_t> dropped;
};
std::string encode_strip(const PieceStrip& strip);
PieceStrip decode_strip(std::string_view bytes, std::string_view what);

std::string encode_samples(const std::vector<SurfaceSamples>& samples);
std::vector<SurfaceSamples> decode_samples(std::string_view bytes, std::string_view what);

/// A separate mesh of some of a mesh's triangles.
Mesh surface_of(const Mesh& mesh, std::span<const Triangle> triangles);
/// A separate mesh of the boundary triangles, which are the last of the stitched mesh.
Mesh last_triangles(const StitchedMesh& stitched);
std::string encode_surface(const Mesh& mesh);  // positions and triangles
Mesh decode_surface(std::string_view bytes, std::string_view what);

/// Opens the file for one section.
std::string read_section(const JobContext& context, const SectionRef& ref);

/// Encodes a mesh as a result of one rung.
std::string encode_piece(const Mesh& mesh, std::uint32_t locked, PositionType positions);

/// The result of weighing a mesh.
struct WeighedMesh {
  std::string ladder;  // a result: the mesh as it was, cleaned, and states nearer to the target
  std::vector<std::uint64_t> rungs;  // its triangles
  PieceWeight weight;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
};

/// The file of a piece or a group; its sections are written as they are made.
class PieceFile {
 public:
  FileSection add(std::string_view bytes) { return sections_.add(bytes); }
  void add_weighed(WeighedMesh weighed, DividedPiece& made);
  JobOutput publish(const Job& job, const JobContext& context, std::string summary) const;

 private:
  std::string file_;
  SectionWriter sections_{[this](std::string_view bytes) { file_ += bytes; }};
};

/// Weighs a mesh. Its first `locked` vertices stay.
WeighedMesh weigh(Mesh mesh, std::uint32_t locked, PositionType positions,
                  const WeighParameters& parameters, const JobContext& context);

}  // namespace meshfarm
