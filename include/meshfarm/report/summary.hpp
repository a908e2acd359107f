// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/facing_repair.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/stream_file.hpp>

namespace meshfarm {

enum class Format { text, json };

/// The distance between the result of a run and its input, in the mesh's unit: from points of the
/// input to the result, and from points of the result to the input.
struct MeasuredError {
  Distance to_output;
  Distance to_input;
  /// Nothing if the result was measured in pieces, each of which has its own.
  std::optional<DistanceQuantiles> to_output_quantiles = {};
  std::optional<DistanceQuantiles> to_input_quantiles = {};
  /// At points of the input; nothing if the result was measured in pieces.
  std::optional<NormalDeviation> to_output_normals = {};
  std::uint64_t normal_samples = 0;
  std::uint64_t input_samples = 0;  // by area; 0: nothing to measure
  std::uint64_t output_samples = 0;

  /// The larger of both directions.
  Distance greater() const {
    return {std::max(to_output.rms, to_input.rms), std::max(to_output.mean, to_input.mean),
            std::max(to_output.max, to_input.max)};
  }
};

/// A better number of triangles to ask for.
struct BetterCount {
  std::uint64_t triangles = 0;
  MeasuredError error;
};

/// The change of topology, relative to the welded and cleaned input.
struct TopologyChange {
  Topology before;
  Topology after;
  GoneComponents gone;
};

/// A channel of the result and its error relative to the input: the root mean square, in the
/// channel's own unit.
struct ChannelError {
  std::string name;
  double rms = 0;
};

/// What happened to the input's texture coordinates and pictures.
struct TexturesMade {
  enum class Way : std::uint8_t { none, kept, baked, dropped };
  Way way = Way::none;
  std::size_t pictures = 0;  // that were kept
  std::uint64_t floor = 0;   // approximate minimum of triangles of a result that keeps the charts
  std::uint32_t size = 0;    // side of the baked picture, in pixels
  std::uint64_t charts = 0;  // in the baked picture
  double charts_share = 0;   // fraction of the picture
};

/// The distance of a piece of the result from the input.
struct ErrorOfPiece {
  std::uint32_t first_part = 0;
  std::uint32_t parts = 0;      // of the input, in this piece; 0: the surroundings of the seams
  std::uint64_t triangles = 0;  // without those between it and the surroundings of the seams
  Distance to_output;           // from its share of the input
  Distance to_input;
  DistanceQuantiles to_output_quantiles;
  DistanceQuantiles to_input_quantiles;
};

/// The shape of a mesh on its own.
struct SurfaceFigures {
  ShapeMeasures shape;
  bool is_closed = false;  // so that the volume is meaningful
  std::optional<EdgeLengths> edges;
  std::optional<std::uint64_t> crossing_triangles;
  std::string crossings_skipped;  // why they were not counted although the mesh is in memory
};

/// A value for crossings_skipped.
inline constexpr const char* k_too_many_at_one_place = "too many lie at one place";

/// The results of a run, for people and for programs.
struct RunSummary {
  Manifest manifest;
  std::uint64_t run = 0;     // its key
  std::uint32_t epoch = 0;   // of the ventilator that its sink served
  std::string output;        // path of the result
  std::uint64_t target = 0;  // triangles asked for, 0: as few as max_error allows
  double max_error = 0;      // maximum distance allowed, in the mesh's unit; 0: any
  /// Upper bound of the distance of every point of the result from the input, and of the input from
  /// the result; 0: not proven.
  double certified_error = 0;
  std::uint64_t triangles = 0;  // triangles made
  std::uint64_t vertices = 0;
  std::string why_not_exact;         // empty when triangles == target
  bool topology_simplified = false;  // handles, holes or pieces might go
  /// Nothing if the input's topology is unknown.
  std::optional<TopologyChange> topology;
  std::uint64_t turned = 0;  // triangles that faced opposite to most of their component's area
  DroppedComponents dropped_components;  // and their triangles before the finish
  MeasuredError error;
  std::optional<SurfaceFigures> result;  // its own figures; nothing if it is in pieces
  std::optional<FacingMended> facing;    // if it was checked
  std::vector<ChannelError> channels;    // that were written
  std::optional<LabelMeaning> labels;    // that were written
  bool labels_too_fine = false;          // so they were dropped
  TexturesMade textures;
  std::vector<std::string> channels_not_wanted;  // names of channels and labels of the stage
  /// Set if the result is ruined and slightly more triangles would have avoided that.
  std::optional<BetterCount> better;
  std::uint64_t stitched = 0;            // triangles of the stitched mesh, before the finish
  std::uint64_t fitted_vertices = 0;     // moved after the sink's finish
  std::uint64_t dropped_degenerate = 0;  // cut, parts and finish together
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t finished_in_pieces = 0;  // 0: the sink finished it
  std::string why_finished_here;         // if the farm should have finished it
  std::vector<ErrorOfPiece> pieces;
  double farm_seconds = 0;
  double stitch_seconds = 0;
  double finish_seconds = 0;
  double measure_seconds = 0;
  double write_seconds = 0;
};

/// The output of `info` for a mesh file.
struct FileSummary {
  std::string path;
  MeshFileInfo file;
  Box box;
  std::uint64_t triangles = 0;
  std::uint64_t short_faces = 0;         // faces with fewer than three corners, left out
  std::uint64_t not_finite = 0;          // vertices with a coordinate that is not finite
  std::uint64_t dropped_not_finite = 0;  // their triangles, left out
  /// How far corners that belong together are apart; 0 if they are at the same position.
  double near_misses = 0;
  /// Approximate minimum of triangles of a result that keeps the textures; 0 if unknown.
  std::uint64_t texture_floor = 0;
  /// With coincident vertices welded as in a run, and as in the file.
  std::optional<Topology> welded;
  std::optional<Topology> as_it_is;
  std::optional<SurfaceFigures> figures;
  std::string not_measured;  // why edge lengths and crossings were not measured
};

/// The output of `info` for a stream.
struct StreamSummary {
  std::string path;
  StreamInfo stream;
  Box box;
  std::uint64_t blocks = 0;
  std::uint64_t widest_front = 0;  // maximum number of vertices that are present and not finalised
};

/// The differences between channels of two meshes, at the points where distances are measured.
struct ChannelDifference {
  std::string name;  // "colours" and "normals" of three channels, else the channel's
  ChannelRole role = ChannelRole::quality;
  /// Colours as fractions of their full range, normals in degrees, others in their own unit.
  ValueError a_to_b;
  ValueError b_to_a;
};

/// Where the labels of two meshes differ.
struct LabelDifference {
  std::string name_a;  // LabelMeaning::name
  std::string name_b;
  double a_to_b = 0;  // fraction of A's area with another label at the nearest place of B
  double b_to_a = 0;
};

/// The output of `compare` for two meshes.
struct Comparison {
  std::string path_a;
  std::string path_b;
  double diagonal = 0;  // of A's bounding box; distances are fractions of it
  SurfaceError a_to_b;
  SurfaceError b_to_a;
  /// Bounds of the maximum distances over all points, if requested.
  struct Certified {
    DistanceBounds a_to_b;
    DistanceBounds b_to_a;
  };
  std::optional<Certified> certified;
  SurfaceFigures figures_a;
  SurfaceFigures figures_b;
  std::string not_measured;  // why normals, edges and crossings were not measured
  Topology welded_a;
  Topology welded_b;
  Topology as_it_is_a;
  Topology as_it_is_b;
  std::vector<ChannelDifference> channels;  // that both have
  std::string channels_skipped;             // why channels that both have were not compared
  std::vector<std::string> channels_only_a;
  std::vector<std::string> channels_only_b;
  std::optional<LabelDifference> labels;  // if both have labels
  std::string labels_skipped;             // why labels that both have were not compared
  struct Map {
    std::string path;
    double most = 0;  // maximum distance of a vertex of B
  };
  std::optional<Map> map;  // if written
};

/// The output of `benchmark` for this host.
struct HostSummary {
  std::uint64_t speed = 0;   // triangles per second, one thread
  std::uint64_t memory = 0;  // free bytes
  std::uint32_t cores = 1;
};

/// The warnings about a run, on one line; may be empty.
std::string warning_of(const RunSummary& summary);

std::string render(const HostSummary& host, Format format);
std::string render(const Manifest& manifest, const std::string& stage, Format format);
std::string render(const RunSummary& summary, Format format);

/// Where a run's time went, from its summary as JSON. Seconds.
struct RunTimes {
  std::uint64_t run = 0;
  std::uint32_t epoch = 0;  // 0: unknown, from an older version
  std::uint64_t triangles_out = 0;
  double cut = 0;
  double farm = 0;
  double stitch = 0;
  double finish = 0;
  double measure = 0;
  double write = 0;
};
/// Throws DataError naming `what`.
RunTimes parse_run_times(std::string_view text, std::string_view what);

std::string render(const FileSummary& summary, Format format);
std::string render(const StreamSummary& summary, Format format);
std::string render(const Comparison& comparison, Format format);

}  // namespace meshfarm
