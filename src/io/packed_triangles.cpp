// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/packed_triangles.hpp>

namespace meshfarm {

std::string pack_triangles(std::span<const Triangle> triangles) {
  constexpr std::size_t k_usual = 6;
  std::string packed;
  packed.reserve(triangles.size() * k_usual);
  TrianglePacker packer;
  for (const Triangle& t : triangles) packed += packer.pack(t);
  return packed;
}

std::optional<std::vector<Triangle>> unpack_triangles(std::string_view packed) {
  std::array<std::uint16_t, 3> words{};
  std::vector<Triangle> triangles(packed.size() / sizeof words);  // fewer if some are escaped
  std::size_t count = 0;
  std::uint32_t last = 0;
  const char* at = packed.data();
  const char* const end = at + packed.size();
  const auto extended = [](std::uint16_t word) {
    return static_cast<std::uint32_t>(static_cast<std::int16_t>(word));
  };
  for (; static_cast<std::size_t>(end - at) >= sizeof words; ++count) {
    std::memcpy(words.data(), at, sizeof words);
    Triangle& t = triangles[count];
    if (words[0] != k_triangle_escape) {
      t[0] = last + extended(words[0]);
      t[1] = t[0] + extended(words[1]);
      t[2] = t[0] + extended(words[2]);
      at += sizeof words;
    } else {
      at += sizeof words[0];
      if (static_cast<std::size_t>(end - at) < sizeof t) return std::nullopt;
      std::memcpy(t.data(), at, sizeof t);
      at += sizeof t;
    }
    last = t[0];
  }
  if (at != end) return std::nullopt;
  triangles.resize(count);
  return triangles;
}

}  // namespace meshfarm
