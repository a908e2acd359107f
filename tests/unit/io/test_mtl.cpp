// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "io/mtl.hpp"

using namespace meshfarm;

namespace {

MtlMaterial with_map(const std::string& words) {
  const auto made = parse_mtl("newmtl m\nmap_Kd " + words + "\n");
  REQUIRE(made.size() == 1);
  return made[0];
}

}  // namespace

TEST_CASE("materials have names, colours and maps") {
  const auto made = parse_mtl(
      "# a comment\r\nKd 9 9 9\r\nnewmtl red one\r\nKa 0 0 0\r\n\tKd 1 0.5 0\r\n"
      "map_Ka other.png\r\n\r\nnewmtl two\r\nKD 0.25\r\nMAP_KD  my atlas.jpg \r\n");
  REQUIRE(made.size() == 2);
  CHECK(made[0].name == "red one");
  CHECK(made[0].colour == std::array<double, 3>{1, 0.5, 0});
  CHECK(made[0].map.file.empty());
  CHECK(made[1].name == "two");
  CHECK(made[1].colour == std::array<double, 3>{0.25, 0.25, 0.25});
  CHECK(made[1].map.file == "my atlas.jpg");
}

TEST_CASE("options stand before a map's file") {
  CHECK(with_map("a.png").map.scale == std::array<double, 2>{1, 1});
  const MtlMaterial all =
      with_map("-s 2 3 1 -o 0.5 -mm 0 1 -clamp on -imfchan r -bm 0.2 C:\\tex\\a b.png");
  CHECK(all.map.file == "C:\\tex\\a b.png");
  CHECK(all.map.scale == std::array<double, 2>{2, 3});
  CHECK(all.map.offset == std::array<double, 2>{0.5, 0});
  CHECK(all.map.is_clamped);
  CHECK(with_map("-s 1 1 7 4.png").map.file == "4.png");
  CHECK(with_map("-s 1 2 7").map.file == "7");
  CHECK(with_map("-odd").map.file == "-odd");
  CHECK(with_map("\"a b.png\"").map.file == "a b.png");
}

TEST_CASE("a malformed library has what can be read of it") {
  CHECK(parse_mtl("").empty());
  CHECK(parse_mtl("map_Kd a.png\nKd 1 1 1\n").empty());
  const auto made = parse_mtl("newmtl a\nKd spectral x.rfl\nKd\nmap_Kd\nKd nan 1 1");
  REQUIRE(made.size() == 1);
  CHECK(made[0].colour == std::array<double, 3>{1, 1, 1});
  CHECK(made[0].map.file.empty());
}

TEST_CASE("d is the alpha of a material, or else what Tr leaves of 1") {
  const auto made = parse_mtl(
      "newmtl a\nd 0.25\nTr 0\nnewmtl b\nTr 0.25\nnewmtl c\nTr 1\nD -halo 0.5\n"
      "newmtl d\nnewmtl e\nd 7\nnewmtl f\nd x\n");
  REQUIRE(made.size() == 6);
  CHECK(made[0].alpha == 0.25);
  CHECK(made[1].alpha == 0.75);
  CHECK(made[2].alpha == 0.5);
  for (std::size_t i = 3; i < 6; ++i) CHECK(made[i].alpha == 1);
}
