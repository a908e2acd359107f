// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace meshfarm {

/// The size of a result and its distance from the input.
struct CountAndError {
  std::uint64_t triangles = 0;
  double rms = 0;
};

/// A knee is where simplification ruins a surface: past it the error rises out of all proportion to
/// the triangles that are saved, as when boxes lose their corners.
///
/// The decreasing triangle counts that are worth a look for this goal; empty for a large one.
std::vector<std::uint64_t> counts_before_knee(std::uint64_t goal);

/// Whether slightly more triangles have so much less error that the user should be told. On a
/// smooth surface the error is proportional to one divided by the number of triangles.
bool is_past_knee(const CountAndError& made, const CountAndError& better);

/// Whether this is only a little more than the goal.
bool is_a_little_more(std::uint64_t goal, std::uint64_t triangles);

/// Whether an RMS, as a fraction of the diagonal, is worth reporting, and whether it is obvious.
bool is_visible(double rms_of_diagonal);
bool is_plain(double rms_of_diagonal);

}  // namespace meshfarm
