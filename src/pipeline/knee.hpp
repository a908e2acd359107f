// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace meshfarm {

/// A result by its size and how far it is from the input.
struct CountAndError {
  std::uint64_t triangles = 0;
  double rms = 0;
};

/// A knee is where a surface goes to ruin: past it the error rises out of all proportion to the
/// triangles that are saved, as where boxes lose their corners.
///
/// The counts, falling, that are worth a look when so many triangles are the goal; none of a large
/// one.
std::vector<std::uint64_t> counts_before_knee(std::uint64_t goal);

/// Whether so few triangles more have so much less error that it is to be told. On a smooth surface
/// the error goes with one by the triangles.
bool is_past_knee(const CountAndError& made, const CountAndError& better);

/// Whether so many triangles are not many more than the goal.
bool is_a_little_more(std::uint64_t goal, std::uint64_t triangles);

/// Whether an RMS, as a fraction of the diagonal, is worth a word, and whether it is seen at once.
bool is_visible(double rms_of_diagonal);
bool is_plain(double rms_of_diagonal);

}  // namespace meshfarm
