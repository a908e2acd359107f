// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The error of the whole by those of its pieces, which it appends. The few points of the seams'
/// surroundings that no piece's input is near to are measured here.
MeasuredError error_of_pieces(const Stage& stage, const Manifest& manifest,
                              const FinishedPieces& result, unsigned threads,
                              std::vector<ErrorOfPiece>& of_pieces);

}  // namespace meshfarm
