// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// Why only the sink can finish a run: options that jobs do not support, or a result that the sink
/// holds well. Empty: jobs do the finish. If a bound on the error decides how much is left, even
/// a large input may leave a result that the sink holds well.
std::string why_finish_here(const Manifest& manifest, const RunOptions& options);
/// Whether the sink may finish a result under a bound itself, and holds this many triangles well.
bool holds_well(const RunOptions& options, std::uint64_t triangles);
inline constexpr const char* k_sink_holds_it = "the sink holds it well";

/// Whether the input has more than its shape.
bool has_attributes(const Manifest& manifest);

/// A piece of a finished result.
struct PieceOfResult {
  std::uint32_t first_part = 0;
  std::uint32_t parts = 0;  // that it is made of; 0: a group of the seams' surroundings
  FileRef divided_file;
  DividedPiece divided;
  FileRef finished_file;
  FinishedPiece finished;
  std::vector<FileRef> error_files;  // of the jobs that measured it
  PieceError error;                  // from all of them
};

/// A result in pieces: their meshes and the gaps between them. The last pieces are the surroundings
/// of the seams; a single piece has none.
struct FinishedPieces {
  std::vector<PieceOfResult> pieces;
  std::uint64_t target = 0;
  bool simplifies_topology = false;  // handles, holes or pieces may go
  DroppedComponents dropped_components;

  /// Other pieces whose surface may be near the input of this piece; none for the surroundings.
  std::vector<std::size_t> near(std::size_t piece) const;
  /// Groups of the surroundings that may be near a piece, or another group.
  std::vector<std::size_t> seams_near(std::size_t piece) const;
  std::uint64_t triangles() const;
  std::uint64_t vertices() const;
};

}  // namespace meshfarm
