// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

struct MortonItem {
  std::uint64_t code = 0;
  std::uint32_t number = 0;  // of the item there
};

/// The position of `p`, with each coordinate in [-1/2, 1/2], along the Z-order curve: 21 bits per
/// axis, interleaved.
std::uint64_t morton_code(Vec3 p);

/// Sorts by code. A few items with equal codes keep their order; many are sorted along the curve
/// through their own box, so that one far outlier does not leave all others unsorted.
/// `place_of(number)`: the place from which the code was made, in any unit and from any origin.
/// Needs as much memory again.
void sort_along_curve(std::vector<MortonItem>& items,
                      const std::function<Vec3(std::uint32_t)>& place_of);

std::vector<std::uint32_t> numbers_of(std::span<const MortonItem> items);

}  // namespace meshfarm
