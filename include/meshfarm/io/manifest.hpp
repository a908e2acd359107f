// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/sweep_order.hpp>
#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/io/boundary_ref.hpp>
#include <meshfarm/io/bundles.hpp>
#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// How a mesh is divided (Xiong et al. 2008, 3 and 4).
enum class Scheme : std::uint8_t {
  cut,     // into compact parts, each simplified in memory
  stream,  // into slabs along the longest axis, each simplified by a sweep
};

/// One part as the cut made it, or one stream or slab.
struct PartEntry {
  FileRef file;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint32_t boundary_vertices = 0;
  /// Of a part as it was assigned: before triangles were dropped and vertices welded. The
  /// simplification of a part goes by these counts, since they are known before any part is made.
  std::uint64_t shared_triangles = 0;
  std::uint32_t shared_boundary = 0;
};

/// Limited so that one message has room for the names of all.
inline constexpr std::uint32_t k_most_cut_blocks = 288;

/// A cut that is done by the first jobs of a run, over blocks of the input's records.
struct Cutting {
  std::string path;             // of the input, as all hosts see it
  std::uint64_t bytes = 0;      // its size
  std::int64_t changed_ns = 0;  // when it was last written
  std::uint32_t parts = 0;      // as asked for
  std::uint32_t vertex_blocks = 0;
  std::uint32_t triangle_blocks = 0;
  friend bool operator==(const Cutting&, const Cutting&) = default;
};

class ByteReader;
class ByteWriter;
void put_cutting(ByteWriter& out, const Cutting& cutting);
/// Throws DataError for what put_cutting() did not write.
Cutting get_cutting(ByteReader& in);

/// What a cut made of one input: everything a run needs to know. Published last, never changed.
struct Manifest {
  std::string input;         // the path as given, for people
  std::string input_format;  // "PLY ascii, gzip"
  Scheme scheme = Scheme::cut;
  std::string partitioner;             // that made the cut: "METIS 5.1.0"
  std::uint64_t window_triangles = 0;  // of a sweep's buffer
  PositionType positions = PositionType::float32;
  Box box;
  std::uint64_t input_vertices = 0;
  std::uint64_t input_triangles = 0;  // after fans and strips were split
  NearMerges near_merges;
  /// Vertices at the position of an earlier one, unless --weld is off. They are merged, except
  /// where surfaces touch. How many are merged depends on the seams; this number does not.
  std::uint64_t coincident_vertices = 0;
  std::uint64_t dropped_degenerate = 0;  // in the parts and the boundary; depends on the seams
  /// Triangles with two corners at one position: the number reported to people. They are dropped as
  /// degenerate, except where surfaces touch.
  std::uint64_t coincident_corners = 0;
  std::uint64_t dropped_not_finite = 0;  // those with a position that is not finite
  std::uint64_t dropped_duplicate = 0;   // boundary triangles only: workers do this for the parts
  StagedChannels channels;               // of the input's vertices
  std::optional<LabelMeaning> labels;    // of the triangles of parts and boundary
  std::uint64_t label_corners = 0;       // vertices that the labels hold in place
  bool uvs = false;                      // whether these triangles have texture coordinates
  std::uint64_t uv_floor = 0;            // about the fewest triangles that a result has with these
  double uv_side = 0;                    // the length of a picture's side on the surface
  std::vector<StagedPicture> pictures;   // of the labels' materials
  std::vector<std::string> skipped;      // properties and elements that were not kept
  double cut_seconds = 0;
  std::uint64_t boundary_triangles = 0;
  BoundaryFiles boundary;  // a cut makes one file; jobs may make more, which are not staged
  /// Set if the parts are slabs that a run has to sort into streams first. What is known only after
  /// sorting is then missing: coincident vertices, dropped triangles and samples. The counts of
  /// triangles and vertices are those of the input.
  std::optional<Sorting> sorting;
  /// Set if a run has to cut first. What is known only after the cut is missing: box, boundary and
  /// parts.
  std::optional<Cutting> cutting;
  /// Where a run has cut: what any process that needs a part builds it from. Never staged.
  std::optional<BundlesOfMesh> bundles;
  std::vector<PartEntry> parts;    // or streams, or slabs
  std::vector<PartEntry> samples;  // of long streams, by stream: a piece as a part; else no name

  /// The columns that the triangles have.
  ColumnSet columns() const { return {labels.has_value(), uvs}; }
  /// The number of triangles in the parts and the boundary; before the cut, in the input.
  std::uint64_t triangles() const;
  /// Before the cut, the number asked for.
  std::size_t part_count() const { return cutting ? cutting->parts : parts.size(); }
};

/// Sets the floor and the side from those of the parts, in order. The triangles between parts are
/// taken to be in proportion to the parts' boundary vertices.
void set_uv_facts(Manifest& manifest, std::span<const UvFacts> of_parts);

std::string encode_manifest(const Manifest& manifest);
Manifest decode_manifest(std::string_view file, std::string_view what);

}  // namespace meshfarm
