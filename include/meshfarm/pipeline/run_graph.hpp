// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// The jobs of a run. src/pipeline/run_graph.cpp defines them from top to bottom.
JobSource make_job_source(const Manifest& manifest, const RunOptions& options);

/// The memory of the largest job known, in bytes. If the input is still to be cut, or slabs to be
/// sorted, later jobs are estimated.
std::uint64_t memory_wanted(const Manifest& manifest, const RunOptions& options);

/// A new texture, as baked by workers.
struct BakedTexture {
  std::vector<FileRef> texels;         // of the chunks
  std::vector<std::uint32_t> damaged;  // numbers of pictures that could not be decoded
};

/// What a run has reached.
struct RunState {
  Manifest manifest;                       // after the cut or the sorting of slabs, if any
  std::optional<ChosenRungs> chosen;       // once every job that makes the mesh is accepted
  std::optional<FinishedPieces> finished;  // once all jobs are accepted, if jobs do the finish
  std::string why_finish_here;             // otherwise: why jobs do not
  BakedTexture baked;                      // once all jobs are accepted
};

/// From the accepted jobs, in any order. Throws DataError for outputs that cannot be theirs.
RunState state_of_run(const Manifest& manifest, const RunOptions& options,
                      std::span<const AcceptedJob> accepted);

}  // namespace meshfarm
