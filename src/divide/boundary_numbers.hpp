// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/sweep_order.hpp>
#include <meshfarm/io/slab_file.hpp>

namespace meshfarm {

/// The boundary vertices of a share by their place in it, ascending, and the number of each in the
/// part or stream that was made from the share. Coincident ones may have the same number.
struct BoundaryNumbers {
  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> numbers;
  /// Where some stay apart: the same for vertices at one point, whatever their numbers.
  std::vector<std::uint32_t> points;
  /// How many different numbers there are; they go from 0 on.
  std::uint32_t count() const;
};

std::string encode_numbers(const BoundaryNumbers& numbers);
/// Throws DataError.
BoundaryNumbers decode_numbers(std::string_view bytes);

/// The boundary vertices of a share, ascending, each once.
std::vector<std::uint32_t> boundary_places(std::vector<std::uint32_t> boundary);

/// Numbered in the order of their places, none welded.
BoundaryNumbers number_as_they_are(const MeshShare& raw);

/// The numbers that a slab's boundary vertices will have once it is sorted: these count boundary
/// vertices alone, in sweep order. Nothing else needs to be sorted for that, as the slab tells
/// which of those at one point stay apart.
BoundaryNumbers number_boundary(const MeshShare& raw, const Sorting& sorting);

}  // namespace meshfarm
