// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <meshfarm/io/labels.hpp>
#include <meshfarm/render/camera.hpp>

#include "render/paged_array.hpp"

namespace meshfarm {

/// Which vertices are connected by triangles, or by lying at the same place.
class Pieces {
 public:
  static constexpr std::uint64_t k_most_vertices = UINT32_MAX - 1;

  /// Takes 4 bytes a vertex, by `room`, and as much as that allows while places are compared.
  /// Throws IoError.
  Pieces(PagedArray<ScreenPoint>& vertices, const ArrayRoom& room);
  void join(std::span<const WideTriangle> triangles);
  /// Gives each vertex the colour of its piece, and returns how many pieces there are. Their order
  /// is that of their vertices, so that nothing but the file decides on a colour.
  std::uint64_t colour(PagedArray<std::uint32_t>& array);

 private:
  void join_at_one_place(PagedArray<ScreenPoint>& array, std::uint64_t memory_bytes);
  std::uint64_t first_of(std::uint64_t vertex);
  void join(std::uint64_t a, std::uint64_t b);

  PagedArray<std::uint32_t> array_;
  PagedArray<std::uint32_t>::View
      before_;  // how many vertices further ahead another of its piece is
};

}  // namespace meshfarm
