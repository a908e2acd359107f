// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The sink's job beside those that measure the pieces: to write the result. The path is not part
/// of the run, so the job only publishes the counts, vertices u64 | triangles u64.
Job write_job(const FinishedPieces& result);
JobOutput publish_counts(const FinishedPieces& result, const Job& job, const JobContext& context);

/// Writes a result from its pieces, each of which is read twice; the memory does not depend on the
/// number of pieces. Calls `check_stop`, which may throw, between them. The caller must commit().
std::unique_ptr<MeshSink> write_pieces(const Stage& stage, const Manifest& manifest,
                                       const FinishedPieces& result, const MeshOutput& output,
                                       const std::function<void()>& check_stop);

/// The same result as one mesh with the columns of its triangles. Throws DataError if it has too
/// many vertices for 32-bit indices.
Mesh mesh_of_pieces(const Stage& stage, const FinishedPieces& result,
                    const std::function<void()>& check_stop);

}  // namespace meshfarm
