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

/// The boundary vertices of a share by their places in it, ascending, and their numbers in the part
/// or stream made from the share. Coincident vertices may have the same number.
struct BoundaryNumbers {
  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> numbers;
  /// If some vertices stay apart: equal for vertices at one point, whatever their numbers.
  std::vector<std::uint32_t> points;
  /// The number of different numbers; they are contiguous from 0.
  std::uint32_t count() const;
};

std::string encode_numbers(const BoundaryNumbers& numbers);
/// Throws DataError.
BoundaryNumbers decode_numbers(std::string_view bytes);

/// The boundary vertices of a share, ascending, without repetitions.
std::vector<std::uint32_t> boundary_places(std::vector<std::uint32_t> boundary);

/// Numbers them in the order of their places, without welding.
BoundaryNumbers number_as_they_are(const MeshShare& raw);

/// The numbers that a slab's boundary vertices will have once it is sorted: boundary vertices alone
/// are counted, in sweep order. Nothing else needs to be sorted for that, as the slab records which
/// of those at one point stay apart.
BoundaryNumbers number_boundary(const MeshShare& raw, const Sorting& sorting);

}  // namespace meshfarm
