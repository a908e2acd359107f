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

/// The jobs of a run. src/pipeline/run_graph.cpp tells it from top to bottom.
JobSource make_job_source(const Manifest& manifest, const RunOptions& options);

/// What the largest job needs that is known of, in bytes. Where the input is still to be cut, or
/// slabs to be sorted, what comes after that is estimated.
std::uint64_t memory_wanted(const Manifest& manifest, const RunOptions& options);

/// A new texture, as workers have baked it.
struct BakedTexture {
  std::vector<FileRef> texels;         // of the chunks
  std::vector<std::uint32_t> damaged;  // numbers of pictures that could not be decoded
};

/// What a run has come to.
struct RunState {
  Manifest manifest;                       // cut, or its slabs sorted, if that was to be done
  std::optional<ChosenRungs> chosen;       // once every job that makes the mesh is accepted
  std::optional<FinishedPieces> finished;  // once all is, if the finish is made of jobs
  std::string why_finish_here;             // else, why not
  BakedTexture baked;                      // once all is
};

/// By the jobs that are accepted, in any order. Throws DataError for outputs that cannot be theirs.
RunState state_of_run(const Manifest& manifest, const RunOptions& options,
                      std::span<const AcceptedJob> accepted);

}  // namespace meshfarm
