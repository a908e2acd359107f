// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Packed triangles. In most meshes the corners of a triangle have indices near those of the
// previous triangle, so most differences fit into 16 bits: half the size of three indices.
//   triangle = three i16: first corner - first corner of the triangle before (0 before the first),
//              second - first, third - first
//            | escape u16 0x8000 | three u32, the corners
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

inline constexpr std::uint16_t k_triangle_escape = 0x8000;
/// The most bytes that a triangle can take.
inline constexpr std::size_t k_most_packed = 14;

class TrianglePacker {
 public:
  /// The bytes of the next triangle; valid until the next call.
  std::string_view pack(const Triangle& t) {
    // May wrap round; the sums in unpack_triangles() wrap round in the same way.
    const std::array<std::uint32_t, 3> differences = {t[0] - last_, t[1] - t[0], t[2] - t[0]};
    last_ = t[0];
    bool fits = true;
    for (std::size_t k = 0; k < 3; ++k) {
      fits = fits && differences[k] + 0x7fff <= 0xfffe;  // from -0x7fff to 0x7fff
      words_[k] = static_cast<std::uint16_t>(differences[k]);
    }
    std::size_t words = 3;
    if (!fits) {
      words_[0] = k_triangle_escape;
      std::memcpy(&words_[1], t.data(), sizeof t);
      words = words_.size();
    }
    return {reinterpret_cast<const char*>(words_.data()), words * sizeof words_[0]};
  }

 private:
  std::uint32_t last_ = 0;
  std::array<std::uint16_t, 7> words_{};
};

std::string pack_triangles(std::span<const Triangle> triangles);
/// All triangles of the bytes; nothing if these end within a triangle. The corners are not checked.
std::optional<std::vector<Triangle>> unpack_triangles(std::string_view packed);

}  // namespace meshfarm
