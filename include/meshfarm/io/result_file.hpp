// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {

/// One rung of a part's ladder: the part after all collapses up to a cost level.
struct Rung {
  std::int32_t level = 0;  // rising along the ladder
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;       // falling along the ladder
  std::uint64_t free_triangles = 0;  // triangles without a locked vertex
  double error = 0;                  // greatest distance from the samples, if it was measured
  FileSection section = {};          // of the result's file
  std::uint64_t refused = 0;         // Simplifier::refused_by_topology(), up to here
};

/// The facts of a part that was built and simplified by one job: those of PartEntry, and what was
/// found on the way.
struct BuiltFacts {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint32_t boundary_vertices = 0;
  std::uint64_t shared_triangles = 0;  // as in PartEntry
  std::uint32_t shared_boundary = 0;
  std::uint64_t coincident_vertices = 0;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t coincident_corners = 0;
};

/// The maximum number of rungs of a ladder.
inline constexpr std::uint32_t k_most_rungs = 256;

/// Why a ladder ends.
enum class LadderEnd : std::uint8_t {
  floor,    // the least that is left of any part is reached, or nothing more collapses
  enough,   // the next rung would not have been wanted
  refusals  // too much is refused for the topology to be kept as far down as wanted
};

/// What is known of a result without reading its file. Sent with the result message.
struct ResultSummary {
  std::vector<Rung> rungs;
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  bool held_by_topology = false;  // more collapses were refused for the topology than made
  std::uint64_t turned = 0;  // triangles that faced another way than most of their piece's area
  std::optional<BuiltFacts> built = {};
  LadderEnd end = LadderEnd::floor;
  FileSection tail = {};    // in the file: what all rungs have in common
  FileSection beside = {};  // in the file: what is no part of the mesh

  /// Whether more could have collapsed.
  bool goes_on() const { return end != LadderEnd::floor; }
};

/// Where a reader of one rung finds it, the tail, and the bytes beside the mesh.
struct RungPlace {
  FileSection rung;
  FileSection tail;
  FileSection beside;
};
inline RungPlace place_of(const ResultSummary& summary, std::size_t rung) {
  return {summary.rungs.at(rung).section, summary.tail, summary.beside};
}

std::string encode_summary(const ResultSummary& summary);
ResultSummary decode_summary(std::string_view bytes, std::string_view what);

/// Writes a result as it is made: its rungs, finest first, each piece by piece. Keeps nothing, so
/// that a result may be larger than the memory. The first vertices of every rung are the part's
/// boundary vertices, unmoved; they are written once, at the end.
class ResultWriter {
 public:
  using Write = std::function<void(std::string_view)>;

  /// The format of the vertices.
  struct Vertices {
    PositionType positions = PositionType::float32;
    bool appearances = false;
    std::uint32_t boundary = 0;
    ColumnSet columns = {};
  };
  /// `beside`: bytes that the file holds for other readers than those of the mesh.
  ResultWriter(const Vertices& vertices, Write write, std::string_view beside = {});
  /// Adds to a rung: its next vertices, numbered on from the boundary vertices, and triangles of
  /// any of the rung's vertices, including later ones; with the columns of the mesh.
  void add(VertexView vertices, std::span<const Triangle> triangles,
           const TriangleColumnsView& columns = {});
  void end_rung(std::int32_t level, std::uint64_t free_triangles, double error = 0,
                std::uint64_t refused = 0);
  /// A whole rung: the mesh's first vertices are the boundary vertices. `opened`: the mesh's
  /// Simplifier::opened().
  void add_rung(std::int32_t level, const Mesh& mesh, std::uint64_t free_triangles,
                double error = 0, std::uint64_t refused = 0,
                std::span<const std::uint32_t> opened = {});
  /// Of the last rung, where more was refused since, and nothing collapsed.
  void set_refused(std::uint64_t refused) { rungs_.back().refused = refused; }
  /// Samples: points of the original part, for measuring the error of the final mesh.
  void finish(const VertexView& boundary, std::span<const SurfaceSamples> samples);

  /// Where the bytes beside the mesh are and, once it is finished, the tail.
  const FileSection& beside() const { return beside_; }
  const FileSection& tail() const { return tail_; }
  /// For the finished file; `made` is a Simplifier or has the same counts.
  template <class Made>
  ResultSummary summary_of(const Made& made) const {
    ResultSummary summary{rungs_, made.dropped_degenerate(), made.dropped_duplicate()};
    summary.turned = made.turned();
    summary.tail = tail_;
    summary.beside = beside_;
    return summary;
  }
  bool empty() const { return rungs_.empty(); }
  const std::vector<Rung>& rungs() const { return rungs_; }

 private:
  void begin_rung(std::span<const std::uint32_t> opened);
  void put(std::string_view bytes);
  FileSection end_section();

  Vertices vertices_;
  Write write_;
  FileSection beside_;
  FileSection tail_;
  FileSection section_;  // being written
  Rung rung_;            // the counts of what was added to the next rung
  std::vector<Rung> rungs_;
  Checksum sum_;
};

/// The format of a result of this part.
inline ResultWriter::Vertices vertices_of(const Part& part) {
  return {part.positions, !part.mesh.appearances.empty(), part.boundary_vertices,
          part.mesh.columns.set()};
}

/// One rung of a result. The first `boundary_vertices` are the part's, unmoved.
struct ResultMesh {
  Mesh mesh;
  std::uint32_t boundary_vertices = 0;
  PositionType positions = PositionType::float32;
  std::vector<std::uint32_t> opened;  // Simplifier::opened()
  std::vector<SurfaceSamples> samples;
};

/// Decodes the rung with this index from its section and the tail; the caller has verified their
/// checksums. Throws DataError naming `what`, as all here do.
ResultMesh decode_rung(std::string_view rung_bytes, std::string_view tail, std::size_t rung,
                       std::string_view what);
/// The same from a whole file; verifies all of its checksums.
ResultMesh decode_result(std::string_view file, std::size_t rung, std::string_view what);

}  // namespace meshfarm
