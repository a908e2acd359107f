// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A tree of boxes that may change, in slots whose order keeps near boxes together. It has four
/// children per node, found by their places, as in a heap. Boxes are stored as floats, rounded
/// outwards.
class BoxTree {
 public:
  /// `center` and `scale` bring most coordinates into [-1, 1].
  struct Frame {
    Vec3 center;
    double scale = 1;
  };

  void build(const Frame& frame, std::span<const Box> boxes);
  /// An empty box touches nothing.
  void set(std::uint32_t slot, const Box& box);

  /// Appends the slots whose boxes touch, and perhaps some that nearly do.
  void find_touching(const Box& box, std::vector<std::uint32_t>& slots) const;

 private:
  // The types are those of GNU C++, which clang has too.
  using Lanes = float __attribute__((vector_size(16)));
  using Mask = std::int32_t __attribute__((vector_size(16)));
  struct Four {
    std::array<Lanes, 3> lo;
    std::array<Lanes, 3> hi;
  };
  struct Rounded {
    std::array<float, 3> lo;
    std::array<float, 3> hi;
  };

  Rounded rounded_outwards(const Box& box) const;
  static unsigned lanes_of(Mask mask);
  static Rounded around(const Four& four);
  static bool has(const Four& four, std::size_t lane, const Rounded& box);
  static void put(Four& four, std::size_t lane, const Rounded& box);

  Frame frame_;
  std::vector<std::vector<Four>>
      levels_;  // the boxes, then those around each four of the level before
};

}  // namespace meshfarm
