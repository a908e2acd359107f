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

// The jobs of a finish that no process holds whole. Pieces, parts that were composed, are divided
// again: what lies round a seam between pieces leaves its piece ("split") and is joined with what
// does on the seam's other side ("seam"). So the seams lie inside of new pieces, and what is held
// now lies where nothing was held before. The surroundings of all seams are one piece or several
// groups: where groups meet, a few vertices stay held. Each new piece is simplified to its quota of
// the triangles ("reduce"), and measured ("measure"), while the sink writes the result ("write").
// Small components are looked for before that ("components").

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

/// Costs at which triangles are counted are the same in all pieces: so many steps are a level.
inline constexpr std::int32_t k_steps_a_level = 4;
double step_cost(std::int32_t step, double unit);

/// How a piece is weighed: simplified step by step to so small a share of what it has at the first.
struct WeighParameters {
  double cost_unit = 0;          // of step 0
  std::int32_t first_step = -1;  // -1: to be found
  double last_share = 0;         // where it ends
  double kept_share = 0;         // where the mesh is kept, to go on from there
  /// Where false, as a bound on the error decides how far all goes: it stays as it is.
  bool is_weighed = true;
  SampleCounts samples;  // what those that were taken are shared out by
  LineOptions lines;
};

/// How many triangles a piece has at which cost.
struct PieceWeight {
  std::uint64_t before = 0;  // at no cost
  std::int32_t first_step = 0;
  std::vector<std::uint64_t> counts;  // after each step, falling
  bool has_open_border = false;       // along which edges can be collapsed

  /// Once all is collapsed that costs no more than the step.
  std::uint64_t at(std::int32_t step) const;
  /// Whether it can lose triangles one by one: at an open border, or as it was seen to.
  bool can_be_odd() const;
};

/// A vertex of the surroundings of the seams before they are joined.
struct SeamVertex {
  std::uint32_t piece = 0;
  std::uint32_t vertex = 0;  // of what the piece gives to them
  friend auto operator<=>(const SeamVertex&, const SeamVertex&) = default;
};

/// A piece that is divided again, or a group of the seams' surroundings: sections of its file.
struct DividedPiece {
  FileSection mesh;  // a result whose boundary vertices are those that are shared
  /// Of a piece: its triangles between the mesh and the surroundings. Of a group: those between it
  /// and other groups.
  FileSection gap;
  FileSection strip;    // of a piece: what it gives to the groups. Of a group: what is shared
  FileSection samples;  // of the input, by which the error is measured
  FileSection fitting;  // others, which the vertices are fitted to
  /// Of a composed piece: the input's triangles between its parts. Of a group: those between
  /// pieces.
  FileSection between;
  std::uint64_t gap_triangles = 0;    // that are the piece's to write: the first of the gap
  std::uint64_t strip_triangles = 0;  // of a group: the input's between pieces
  std::uint64_t shared = 0;           // vertices of other pieces that the gap has
  Box box;                            // of a piece as it came; of a group
  std::vector<std::uint64_t> rungs;   // triangles of the result's rungs
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
  PieceWeight weight;
};
std::string encode_summary(const DividedPiece& piece);
DividedPiece decode_divided_piece(std::string_view bytes, std::string_view what);

/// Parameters of the job that finds components which are to be left out. They may span pieces. It
/// reads these one after the other: none is an input.
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
  double diagonal = 0;  // smaller ones are left out
};
std::string encode_parameters(const ComponentsParameters& parameters);
ComponentsParameters decode_components_parameters(std::string_view bytes);

/// What it finds: of each piece a section of its file, with the lowest vertices of the components
/// of the piece that are to be left out.
struct SmallComponents {
  std::vector<FileSection> pieces;
  DroppedComponents dropped;  // a component that spans pieces counts once
};
std::string encode_summary(const SmallComponents& components);
SmallComponents decode_small_components(std::string_view bytes, std::string_view what);

struct SplitParameters {
  std::uint32_t piece = 0;
  std::uint32_t rung = 0;
  std::int32_t step = -1;  // what costs no more is collapsed before; -1: nothing
  bool is_composed = false;
  SectionRef small_components;  // to be left out before; no name: there are none
  WeighParameters weigh;
};
std::string encode_parameters(const SplitParameters& parameters);
SplitParameters decode_split_parameters(std::string_view bytes);

/// Of a seam job whose group is simplified as far as a bound on the error allows.
struct GroupBound {
  double max_error = 0;
  double certified_error = 0;            // where above 0: it is proven of every point
  std::optional<BundlesOfMesh> bundles;  // what parts are built of, if they are not kept
};

/// Parameters of a seam job. It has no inputs, as none is to be read whole. A seam is of the group
/// that the first of its pieces is of; groups are neighbouring pieces, about as many in each.
struct SeamParameters {
  struct Strip {
    std::uint32_t parts = 1;
    SectionRef ref;
    FileSection mesh;  // what stays in the piece, and the gap, where there is a bound
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

/// Of a piece that is finished as it is.
inline constexpr std::uint64_t k_keep_all = UINT64_MAX;

/// Of a job with two sections of one input: DividedPiece::mesh, and fitting if there is any.
struct ReduceParameters {
  std::uint32_t rung = 0;
  std::uint64_t triangles = 0;  // or k_keep_all
  std::uint64_t points = 0;     // of the result, by area, to measure it by
  std::uint64_t vertices = 0;   // and at most so many, and as many middles of sides
  LineOptions lines;
};
std::string encode_parameters(const ReduceParameters& parameters);
ReduceParameters decode_reduce_parameters(std::string_view bytes);

/// A finished piece: sections of its file.
struct FinishedPiece {
  FileSection mesh;           // a result; its boundary vertices are those that are shared, unmoved
  FileSection points;         // of its surface
  std::uint64_t by_area = 0;  // the first of them
  double area = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};
std::string encode_summary(const FinishedPiece& piece);
FinishedPiece decode_finished_piece(std::string_view bytes, std::string_view what);

/// A group of the surroundings that is finished: DividedPiece::gap, and FinishedPiece::mesh.
struct SeamSurface {
  SectionRef mesh;
  SectionRef gap;
};

/// Parameters of a measure job, one of several of a piece. What it reads are sections.
struct MeasureParameters {
  std::uint32_t first_part = 0;  // of the input, that the job measures to
  std::uint32_t end_part = 0;
  std::vector<FileRef> parts;   // these, or streams, if they are kept
  std::uint64_t triangles = 0;  // of the input in the whole piece; 0: a group of the surroundings
  std::optional<BundlesOfMesh> bundles;  // what parts are built of, if they are not kept
  std::uint32_t share = 0;               // of the samples, that the job takes
  std::uint32_t shares = 1;
  Box box;                         // of the piece
  SectionRef mesh;                 // finished
  SectionRef samples;              // of the input
  SectionRef gap;                  // DividedPiece::gap
  SectionRef between;              // DividedPiece::between; no name: another job's, or none
  std::vector<SeamSurface> seams;  // those near the piece, or other groups near the group
  std::vector<SectionRef> points;  // of the result: the piece's own, then those of pieces near it
  std::uint64_t input_step = 1;    // every so-manieth vertex of the input is looked at
  bool with_sides = false;         // and the middles of its triangles' longest sides
};
std::string encode_parameters(const MeasureParameters& parameters);
MeasureParameters decode_measure_parameters(std::string_view bytes);

/// What a measure job finds of its share of the input.
struct PieceError {
  double input_area = 0;  // that the samples stand for
  Distance to_output;
  std::uint64_t input_samples = 0;
};
/// Adds what was found of another share of the piece.
void add_share(const PieceError& more, PieceError& error);

/// The file of a measure job. Of each point of the result the least distance of all files counts.
struct MeasuredPoints {
  /// From MeasureParameters::points to the job's share of the input, HUGE_VAL where that is not
  /// near.
  std::vector<std::vector<double>> to_input;
  std::vector<double> to_output;  // from the samples of the share
  std::vector<double> areas;      // that these stand for
};
std::string encode_points(const MeasuredPoints& points);
MeasuredPoints decode_measured_points(std::string_view bytes, std::string_view what);
std::string encode_summary(const PieceError& error);
PieceError decode_piece_error(std::string_view bytes, std::string_view what);

/// Parameters of the job by which the sink writes the result: what that depends on.
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
