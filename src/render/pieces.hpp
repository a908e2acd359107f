// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/io/labels.hpp>
#include <meshfarm/render/camera.hpp>

#include "render/paged_array.hpp"

namespace meshfarm {

/// Finds vertices that are connected by triangles, or lie at the same position.
class Pieces {
 public:
  static constexpr std::uint64_t k_most_vertices = UINT32_MAX - 1;

  /// Takes 4 bytes per vertex, by `room`. While positions are compared, another 16 in
  /// `memory_for_places` or, beyond that, in a scratch file, and some 34 MB. Throws IoError.
  Pieces(PagedArray<ScreenPoint>& vertices, const ArrayRoom& room, std::uint64_t memory_for_places);
  void join(std::span<const WideTriangle> triangles);
  /// Assigns each vertex the colour of its piece, and returns the number of pieces. Pieces are
  /// ordered by their vertices, so that colours depend on the file alone.
  std::uint64_t colour(PagedArray<std::uint32_t>& array);

 private:
  struct PlacedVertex {
    ScreenPoint place;
    std::uint32_t vertex = 0;
  };

  void join_at_one_place(PagedArray<ScreenPoint>& array, const ArrayRoom& room);
  void join_at_one_place(const std::vector<PlacedVertex>& vertices,
                         std::vector<std::uint32_t>& table);
  std::uint64_t first_of(std::uint64_t vertex);
  void join(std::uint64_t a, std::uint64_t b);
  std::uint64_t join_firsts(std::uint64_t a, std::uint64_t b);

  PagedArray<std::uint32_t> array_;
  PagedArray<std::uint32_t>::View
      before_;  // how many vertices further ahead another of its piece is
};

}  // namespace meshfarm
