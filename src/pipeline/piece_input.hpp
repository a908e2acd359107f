// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The surface of the input for a measure job of a piece.
struct PieceInput {
  std::vector<Mesh> parts;  // read, or built where they are not kept
  Mesh between;             // between the parts of the whole piece, if it is this job's
  Box box;                  // of all
};
/// Throws as reading does.
PieceInput read_piece_input(const Stage& stage, const MeasureParameters& parameters);

}  // namespace meshfarm
