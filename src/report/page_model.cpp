// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A model, little endian:
//   vertices u32, triangles u32, largest side of the box f32, sides of the box f32 x 3
//   a vertex: x, y, z u16 (over its side of the box), value u16 (0 to 65535)
//   a corner of a triangle: how far its vertex is before the next new one, as groups of 7 bits,
//   the lowest first, bit 7 set in all but the last. 0: it is the next new one.
// Vertices are in the order of their first use, triangles along a curve.
#include <algorithm>
#include <cmath>
#include <limits>

#include <meshfarm/geometry/curve_order.hpp>
#include <meshfarm/report/run_page.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {
namespace {

constexpr double k_most = std::numeric_limits<std::uint16_t>::max();

std::uint16_t in_16_bits(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * k_most));
}

void put_groups(ByteWriter& out, std::uint32_t number) {
  for (; number >= 128; number >>= 7) out.put(static_cast<std::uint8_t>(number | 128));
  out.put(static_cast<std::uint8_t>(number));
}

}  // namespace

std::string encode_model(const Mesh& mesh, std::span<const float> values) {
  constexpr std::uint32_t k_not_used = UINT32_MAX;
  std::vector<std::uint32_t> number(mesh.positions.size(), k_not_used);
  std::vector<std::uint32_t> used;
  ByteWriter corners;
  for (const std::uint32_t t : along_a_curve(mesh)) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      const auto next = static_cast<std::uint32_t>(used.size());
      if (number[vertex] == k_not_used) {
        number[vertex] = next;
        used.push_back(vertex);
      }
      put_groups(corners, next - number[vertex]);
    }
  }
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const Vec3 sides = box.hi - box.lo;
  const auto share = [](double value, double side) { return side > 0 ? value / side : 0; };
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(used.size()));
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const double side : {std::max({sides.x, sides.y, sides.z}), sides.x, sides.y, sides.z}) {
    out.put(static_cast<float>(side));
  }
  for (const std::uint32_t vertex : used) {
    const Vec3 p = mesh.positions[vertex] - box.lo;
    out.put(in_16_bits(share(p.x, sides.x)));
    out.put(in_16_bits(share(p.y, sides.y)));
    out.put(in_16_bits(share(p.z, sides.z)));
    out.put(in_16_bits(static_cast<double>(values[vertex])));
  }
  return out.take() + corners.take();
}

}  // namespace meshfarm
