// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

#include "scratch_array.hpp"
#include "scratch_list.hpp"

namespace meshfarm {

/// The distinct texture coordinates that each vertex has in its triangles, each with a number that
/// the user chooses. Kept in up to 96 MB of memory, or in scratch files: 8 bytes per vertex and 24
/// per wedge. (At a vertex with very many wedges, one may occur more than once.)
class CornerWedges {
 public:
  /// For this number of vertices. Throws IoError.
  explicit CornerWedges(std::uint64_t vertices) : newest_(vertices) {}

  /// The wedge's number. That of a new one is `make(is_first)`: whether it is the vertex's first.
  template <class Make>
  std::uint64_t number_of(std::uint64_t vertex, Uv uv, const Make& make) {
    std::uint64_t& newest = newest_.items()[vertex];
    newest_.used(1);
    wedges_.used(1);
    const auto uv_bits = std::bit_cast<std::uint64_t>(uv);
    std::uint64_t at = newest;
    for (int step = 0; at != 0 && step < k_most_steps; ++step) {
      const Wedge& wedge = wedges_[at - 1];
      if (wedge.uv_bits == uv_bits) return wedge.number;
      at = wedge.next;
    }
    const std::uint64_t number = make(newest == 0);
    wedges_.push_back({uv_bits, number, newest});
    newest = wedges_.size();
    return number;
  }

 private:
  static constexpr int k_most_steps = 100;
  struct Wedge {
    std::uint64_t uv_bits = 0;
    std::uint64_t number = 0;
    std::uint64_t next = 0;  // of the same vertex: 1 + its index, or 0
  };
  ScratchArray<std::uint64_t> newest_;  // of each vertex, as `next`
  ScratchList<Wedge> wedges_;
};

/// Makes texture coordinates that every format can hold: what is not finite becomes 0.
inline Uv finite_uv(Uv uv) {
  for (float& x : uv) {
    if (!std::isfinite(x)) x = 0;
  }
  return uv;
}

}  // namespace meshfarm
