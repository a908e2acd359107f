// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Writes a result from its pieces, each of which is read twice: in memory that does not depend on
/// the number of pieces. Calls `check_stop` between them, which may throw.
void write_pieces(const Stage& stage, const Manifest& manifest, const FinishedPieces& result,
                  const MeshOutput& output, const std::function<void()>& check_stop);

/// The same result as one mesh, with what its triangles have. Throws DataError if it has too many
/// vertices for 32-bit indices.
Mesh mesh_of_pieces(const Stage& stage, const FinishedPieces& result,
                    const std::function<void()>& check_stop);

/// The error of the whole by those of its pieces, which it appends. The few points of the seams'
/// surroundings that no piece's input is near to are measured here.
MeasuredError error_of_pieces(const Stage& stage, const Manifest& manifest,
                              const FinishedPieces& result, unsigned threads,
                              std::vector<ErrorOfPiece>& of_pieces);

}  // namespace meshfarm
