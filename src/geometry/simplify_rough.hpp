// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "geometry/collapse.hpp"

namespace meshfarm {

/// What a rough pass reads: the state of the pass, and who took part in a collapse of it already.
struct RoughState {
  CollapseState collapse;
  std::span<const std::uint8_t> touched;
};

/// Choices of a pass that ranks no edges: it walks through the vertices in their order and merges
/// each with its nearest neighbour, if that costs little enough.
class RoughPass {
 public:
  explicit RoughPass(const RoughState& state) : state_(state) {}

  /// The nearest neighbour that the vertex may merge with; the vertex itself if there is none.
  std::uint32_t partner(std::uint32_t vertex) const;

  /// The cost that the cheapest `share` (0 to 1) of the vertices would pay to merge with their
  /// partners, but no more than `most`, estimated from a sample; nothing if too few could for it.
  std::optional<double> estimate_limit(CollapseJudge& judge, double share, double most) const;

 private:
  RoughState state_;
};

}  // namespace meshfarm
