// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/box_tree.hpp"

using namespace meshfarm;

namespace {

bool meet(const Box& a, const Box& b) {
  return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y &&
         a.lo.z <= b.hi.z && b.lo.z <= a.hi.z;
}

}  // namespace

TEST_CASE("box tree: finds what touches, after changes, too") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0, 1);
  const auto some_box = [&] {
    Box box;
    const Vec3 corner{at(random), at(random), at(random)};
    box.add(corner);
    box.add(corner + Vec3{at(random), at(random), at(random)} * 0.1);
    return box;
  };
  std::vector<Box> boxes(301);
  std::generate(boxes.begin(), boxes.end(), some_box);
  BoxTree tree;
  tree.build({{0.5, 0.5, 0.5}, 1}, boxes);
  for (std::uint32_t round = 0; round < 300; ++round) {
    boxes[round] = round % 3 == 0 ? Box{} : some_box();
    tree.set(round, boxes[round]);
    const Box asked = some_box();
    std::vector<std::uint32_t> found;
    tree.find_touching(asked, found);
    std::size_t missed = 0;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].empty() || !meet(boxes[i], asked)) continue;
      missed += std::count(found.begin(), found.end(), i) == 1 ? 0 : 1;
    }
    CHECK(missed == 0);
    CHECK(std::none_of(found.begin(), found.end(), [&](auto i) { return boxes[i].empty(); }));
    CHECK(found.size() < 100);
  }
}

TEST_CASE("box tree: of nothing") {
  BoxTree tree;
  tree.build({}, {});
  Box box;
  box.add({});
  std::vector<std::uint32_t> found;
  tree.find_touching(box, found);
  CHECK(found.empty());
}
