// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/geometry/components.hpp>
#include <meshfarm/io/bundles.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/sections.hpp>

namespace meshfarm {

// The jobs of a finish that no single process holds as a whole. Composed pieces are divided again:
// the surroundings of a seam between pieces leave their piece ("split") and are joined with those
// from the other side of the seam ("seam"). So the old seams lie inside new pieces, and the
// vertices locked now lie where none were locked before. The surroundings of all seams are one
// piece or several groups; where groups meet, a few vertices stay locked. Each new piece is
// simplified to its quota of triangles ("reduce") and measured ("measure"), while the sink writes
// the result ("write"). Small components are looked for before all this ("components").

inline constexpr std::string_view k_components_kind = "components";
inline constexpr std::string_view k_split_kind = "split";
inline constexpr std::string_view k_seam_kind = "seam";
inline constexpr std::string_view k_reduce_kind = "reduce";
inline constexpr std::string_view k_measure_kind = "measure";
inline constexpr std::string_view k_write_kind = "write";

/// A section of a staged file.
struct SectionRef {
  FileRef file;
  FileSection section;
};

/// Triangles are counted at the same costs in all pieces, at this many steps per level.
inline constexpr std::int32_t k_steps_a_level = 2;
double step_cost(std::int32_t step, double unit);

/// How a piece is weighed: it is simplified step by step to a share of its triangles at the first
/// step.
struct WeighParameters {
  double cost_unit = 0;          // of step 0
  std::int32_t first_step = -1;  // -1: to be determined
  double last_share = 0;         // where weighing ends
  double kept_share = 0;         // where the mesh is kept, to continue from there
  /// False if a bound on the error decides how far everything goes: the piece stays unchanged.
  bool is_weighed = true;
  SampleCounts samples;  // how to split the samples
  LineOptions lines;
};

/// The number of triangles of a piece at each cost.
struct PieceWeight {
  std::uint64_t before = 0;  // at no cost
  std::int32_t first_step = 0;
  std::vector<std::uint64_t> counts;  // after each step, decreasing
  bool has_open_border = false;       // along which edges can be collapsed

  /// After all collapses that cost no more than the step.
  std::uint64_t at(std::int32_t step) const;
  /// Whether it can lose single triangles: at an open border, or because its counts show it.
  bool can_be_odd() const;
};

/// A vertex of the surroundings of the seams before they are joined.
struct SeamVertex {
  std::uint32_t piece = 0;
  std::uint32_t vertex = 0;  // in what the piece gives to the surroundings
  friend auto operator<=>(const SeamVertex&, const SeamVertex&) = default;
};

/// A divided piece, or a group of the seams' surroundings: sections of its file.
struct DividedPiece {
  FileSection mesh;  // a result whose boundary vertices are the shared ones
  /// Of a piece: its triangles between the mesh and the surroundings. Of a group: those between it
  /// and other groups.
  FileSection gap;
  FileSection strip;    // of a piece: what it gives to the groups. Of a group: what is shared
  FileSection samples;  // of the input, to measure the error by
  FileSection fitting;  // others, to fit the vertices to
  /// Of a composed piece: the input's triangles between its parts. Of a group: those between
  /// pieces.
  FileSection between;
  std::uint64_t gap_triangles = 0;    // written by this piece: the first of the gap
  std::uint64_t strip_triangles = 0;  // of a group: the input's between pieces
  std::uint64_t shared = 0;           // vertices of other pieces in the gap
  Box box;                            // of a piece before it was divided; of a group
  std::vector<std::uint64_t> rungs;   // triangles of the result's rungs
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
  PieceWeight weight;
};
std::string encode_summary(const DividedPiece& piece);
DividedPiece decode_divided_piece(std::string_view bytes, std::string_view what);

/// Parameters of the job that finds the components to leave out. Components may span pieces. The
/// job reads the pieces one after the other, so none is an input.
struct ComponentsParameters {
  struct Piece {
    std::uint32_t parts = 1;
    std::uint32_t rung = 0;
    FileRef file;
    FileSection mesh;  // the rung
    FileSection tail;
  };
  std::vector<Piece> pieces;  // in order
  std::uint32_t all_parts = 0;
  BoundaryFiles boundary;
  double diagonal = 0;  // components with a smaller diagonal are left out
};
std::string encode_parameters(const ComponentsParameters& parameters);
ComponentsParameters decode_components_parameters(std::string_view bytes);

/// Its result: per piece a section of its file with the lowest vertices of the piece's components
/// that are to be left out.
struct SmallComponents {
  std::vector<FileSection> pieces;
  DroppedComponents dropped;  // a component that spans pieces counts once
};
std::string encode_summary(const SmallComponents& components);
SmallComponents decode_small_components(std::string_view bytes, std::string_view what);

struct SplitParameters {
  std::uint32_t piece = 0;
  std::uint32_t rung = 0;
  std::int32_t step = -1;  // collapses up to this cost are done before; -1: none
  bool is_composed = false;
  SectionRef small_components;  // left out before; no name: there are none
  WeighParameters weigh;
};
std::string encode_parameters(const SplitParameters& parameters);
SplitParameters decode_split_parameters(std::string_view bytes);

/// For a seam job whose group is simplified as far as a bound on the error allows.
struct GroupBound {
  double max_error = 0;
  double certified_error = 0;            // where above 0: to be proven for every point
  std::optional<BundlesOfMesh> bundles;  // to build the parts from, if they are not kept
};

/// Parameters of a seam job. It has no inputs, as none is read whole. A seam belongs to the group
/// of the first of its pieces; groups consist of neighbouring pieces, about equally many in each.
struct SeamParameters {
  struct Strip {
    std::uint32_t parts = 1;
    SectionRef ref;
    FileSection mesh;  // with a bound: what stays in the piece, and the gap
    FileSection gap;
  };
  std::vector<Strip> strips;  // of the pieces, in order
  std::uint32_t group = 0;
  std::uint32_t groups = 1;
  std::uint32_t all_parts = 0;
  BoundaryFiles boundary;
  double samples_per_triangle = 0;
  std::optional<GroupBound> bound;
  WeighParameters weigh;
};
std::string encode_parameters(const SeamParameters& parameters);
SeamParameters decode_seam_parameters(std::string_view bytes);

/// For a piece that is finished unchanged.
inline constexpr std::uint64_t k_keep_all = UINT64_MAX;

/// For a job with two sections of one input: DividedPiece::mesh, and fitting if there is any.
struct ReduceParameters {
  std::uint32_t rung = 0;
  std::uint64_t triangles = 0;  // or k_keep_all
  std::uint64_t points = 0;     // of the result, by area, to measure it by
  std::uint64_t vertices = 0;   // at most; and at most as many midpoints of sides
  LineOptions lines;
};
std::string encode_parameters(const ReduceParameters& parameters);
ReduceParameters decode_reduce_parameters(std::string_view bytes);

/// A finished piece: sections of its file.
struct FinishedPiece {
  FileSection mesh;           // a result; its boundary vertices are the shared ones, unmoved
  FileSection points;         // on its surface
  std::uint64_t by_area = 0;  // the first of them
  double area = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};
std::string encode_summary(const FinishedPiece& piece);
FinishedPiece decode_finished_piece(std::string_view bytes, std::string_view what);

/// A finished group of the surroundings: DividedPiece::gap and FinishedPiece::mesh.
struct SeamSurface {
  SectionRef mesh;
  SectionRef gap;
};

/// Parameters of a measure job, one of several for a piece. It reads sections only.
struct MeasureParameters {
  std::uint32_t first_part = 0;  // of the input, that the job measures to
  std::uint32_t end_part = 0;
  std::vector<FileRef> parts;   // or streams, if they are kept
  std::uint64_t triangles = 0;  // of the input in the whole piece; 0: a group of the surroundings
  std::optional<BundlesOfMesh> bundles;  // to build the parts from, if they are not kept
  std::uint32_t share = 0;               // of the samples: the one of this job
  std::uint32_t shares = 1;
  Box box;                         // of the piece
  SectionRef mesh;                 // finished
  SectionRef samples;              // of the input
  SectionRef gap;                  // DividedPiece::gap
  SectionRef between;              // DividedPiece::between; no name: another job's, or none
  std::vector<SeamSurface> seams;  // those near the piece, or other groups near the group
  std::vector<SectionRef> points;  // of the result: the piece's own, then those of pieces near it
  std::uint64_t input_step = 1;    // only every `input_step`-th vertex of the input is checked
  bool with_sides = false;         // also checks the midpoints of its triangles' longest sides
};
std::string encode_parameters(const MeasureParameters& parameters);
MeasureParameters decode_measure_parameters(std::string_view bytes);

/// The result of a measure job on its share of the input.
struct PieceError {
  double input_area = 0;  // represented by the samples
  Distance to_output;
  std::uint64_t input_samples = 0;
};
/// Adds the result for another share of the piece.
void add_share(const PieceError& more, PieceError& error);

/// The file of a measure job. For each point of the result the smallest distance in any file
/// counts.
struct MeasuredPoints {
  /// From MeasureParameters::points to the job's share of the input; HUGE_VAL for points that are
  /// not near it.
  std::vector<std::vector<double>> to_input;
  std::vector<double> to_output;  // from the samples of the share
  std::vector<double> areas;      // represented by these samples
};
std::string encode_points(const MeasuredPoints& points);
MeasuredPoints decode_measured_points(std::string_view bytes, std::string_view what);
std::string encode_summary(const PieceError& error);
PieceError decode_piece_error(std::string_view bytes, std::string_view what);

/// Parameters of the job in which the sink writes the result: all that it depends on.
struct WriteParameters {
  std::uint64_t pieces = 0;  // checksum of their files
};
std::string encode_parameters(const WriteParameters& parameters);

JobOutput find_small_components(const Job& job, const JobContext& context);
JobOutput split_piece(const Job& job, const JobContext& context);
JobOutput join_seams(const Job& job, const JobContext& context);
JobOutput reduce_piece(const Job& job, const JobContext& context);
JobOutput measure_piece(const Job& job, const JobContext& context);

}  // namespace meshfarm
