// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The error of the whole, computed from those of its pieces, which are appended to `of_pieces`.
/// The few points of the seams' surroundings that are near no piece's input are measured here.
MeasuredError error_of_pieces(const Stage& stage, const Manifest& manifest,
                              const FinishedPieces& result, unsigned threads,
                              std::vector<ErrorOfPiece>& of_pieces);

}  // namespace meshfarm
