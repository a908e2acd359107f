// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/pipeline/piece_jobs.hpp>

namespace meshfarm {

/// The lowest step at which all pieces together have at most `target` triangles; the last step if
/// there is none.
std::int32_t step_below(std::span<const PieceWeight> pieces, std::uint64_t target);

/// How many triangles each piece is to keep so that all together keep `target`: collapses up to one
/// threshold are done everywhere; of what lies between that step and the next, each piece gives an
/// even share. The reductions are even, because triangles inside a surface go in pairs, except for
/// one piece with an open border if the target needs it; without such a piece the sum is one less.
std::vector<std::uint64_t> share_out_triangles(std::span<const PieceWeight> pieces,
                                               std::uint64_t target);

/// The same again if pieces did not reach their quotas: the excess is taken from those that did, or
/// a piece with one triangle too many loses its last two at once. Empty if that is impossible.
std::vector<std::uint64_t> share_out_again(std::span<const PieceWeight> pieces,
                                           std::span<const std::uint64_t> quotas,
                                           std::span<const std::uint64_t> made);

}  // namespace meshfarm
