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
  std::uint32_t number = 0;  // of what lies there
};

/// The place of `p`, each coordinate in [-1/2, 1/2], along the Z-shaped curve: 21 bits an axis,
/// woven.
std::uint64_t morton_code(Vec3 p);

/// Sorts by code. Few that have one code keep their order; many follow the curve through the box of
/// their own places, so that one far outlier does not leave all others unsorted.
/// `place_of(number)`: the place that the code was made of, in any unit and from any origin. Needs
/// the same memory again.
void sort_along_curve(std::vector<MortonItem>& items,
                      const std::function<Vec3(std::uint32_t)>& place_of);

std::vector<std::uint32_t> numbers_of(std::span<const MortonItem> items);

}  // namespace meshfarm
