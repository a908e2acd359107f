// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/pipeline/piece_jobs.hpp>

namespace meshfarm {

/// The lowest step at which all pieces together have no more than the target; the last there is, if
/// none does.
std::int32_t step_below(std::span<const PieceWeight> pieces, std::uint64_t target);

/// How many triangles each piece is to keep so that all together keep `target`: what all cost that
/// is no more than one threshold is collapsed everywhere; of what lies between that step and the
/// next each piece gives an even share. Differences to what a piece has are even, as inside a
/// surface triangles go in pairs, but for one piece with an open border if the target needs it:
/// without such a piece, the sum is one less.
std::vector<std::uint64_t> share_out_triangles(std::span<const PieceWeight> pieces,
                                               std::uint64_t target);

/// The same once more, where pieces did not come down to their quotas: what they have too many is
/// taken from those that did, or, of one that has one too many, the last two at once. Empty if none
/// can.
std::vector<std::uint64_t> share_out_again(std::span<const PieceWeight> pieces,
                                           std::span<const std::uint64_t> quotas,
                                           std::span<const std::uint64_t> made);

}  // namespace meshfarm
