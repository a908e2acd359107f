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

/// Why a run's finish is the sink's alone: the options that it has no way for, or that the sink
/// does it well. Empty: its finish is made of jobs. Where a bound on the error decides how much is
/// left, a large input may still turn out to be finished well by the sink.
std::string why_finish_here(const Manifest& manifest, const RunOptions& options);
/// Whether that may be, and so many triangles are left.
bool holds_well(const RunOptions& options, std::uint64_t triangles);
inline constexpr const char* k_sink_holds_it = "the sink holds it well";

/// Whether there is more of the input than its shape.
bool has_attributes(const Manifest& manifest);

/// A piece of a result that is finished.
struct PieceOfResult {
  std::uint32_t first_part = 0;
  std::uint32_t parts = 0;  // that it is made of; 0: a group of the surroundings of the seams
  FileRef divided_file;
  DividedPiece divided;
  FileRef finished_file;
  FinishedPiece finished;
  std::vector<FileRef> error_files;  // of the jobs that measured it
  PieceError error;                  // by all of them
};

/// A result in pieces: it consists of their meshes and the gaps between them. The last of them are
/// the surroundings of the seams. If there is one piece only, it has none.
struct FinishedPieces {
  std::vector<PieceOfResult> pieces;
  std::uint64_t target = 0;
  bool simplifies_topology = false;  // handles, holes or pieces might go
  DroppedComponents dropped_components;

  /// Others whose surface may be near the input of a piece; none for the surroundings.
  std::vector<std::size_t> near(std::size_t piece) const;
  /// Groups of the surroundings that may be near a piece, or another group.
  std::vector<std::size_t> seams_near(std::size_t piece) const;
  std::uint64_t triangles() const;
  std::uint64_t vertices() const;
};

}  // namespace meshfarm
