// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace meshfarm {
namespace {

constexpr float k_beyond = std::numeric_limits<float>::max();
// More than rounding to the frame, and then to float, may move a coordinate by.
constexpr double k_margin = 0x1p-22;

}  // namespace

BoxTree::Rounded BoxTree::rounded_outwards(const Box& box) const {
  Rounded rounded{{k_beyond, k_beyond, k_beyond}, {-k_beyond, -k_beyond, -k_beyond}};
  if (box.empty()) return rounded;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = (box.lo[axis] - frame_.center[axis]) * frame_.scale;
    const double hi = (box.hi[axis] - frame_.center[axis]) * frame_.scale;
    const auto i = static_cast<std::size_t>(axis);
    rounded.lo[i] = static_cast<float>(lo - k_margin * std::max(1.0, std::abs(lo)));
    rounded.hi[i] = static_cast<float>(hi + k_margin * std::max(1.0, std::abs(hi)));
  }
  return rounded;
}

BoxTree::Rounded BoxTree::around(const Four& four) {
  Rounded box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Lanes& lo = four.lo[axis];
    const Lanes& hi = four.hi[axis];
    box.lo[axis] = std::min(std::min(lo[0], lo[1]), std::min(lo[2], lo[3]));
    box.hi[axis] = std::max(std::max(hi[0], hi[1]), std::max(hi[2], hi[3]));
  }
  return box;
}

bool BoxTree::has(const Four& four, std::size_t lane, const Rounded& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (four.lo[axis][lane] != box.lo[axis] || four.hi[axis][lane] != box.hi[axis]) return false;
  }
  return true;
}

void BoxTree::put(Four& four, std::size_t lane, const Rounded& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    four.lo[axis][lane] = box.lo[axis];
    four.hi[axis][lane] = box.hi[axis];
  }
}

void BoxTree::build(const Frame& frame, std::span<const Box> boxes) {
  frame_ = frame;
  levels_.clear();
  const Four none{{Lanes{} + k_beyond, Lanes{} + k_beyond, Lanes{} + k_beyond},
                  {Lanes{} - k_beyond, Lanes{} - k_beyond, Lanes{} - k_beyond}};
  std::vector<Four>* level = &levels_.emplace_back((boxes.size() + 3) / 4, none);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    put((*level)[i / 4], i % 4, rounded_outwards(boxes[i]));
  }
  while (level->size() > 1) {
    std::vector<Four> next((level->size() + 3) / 4, none);
    for (std::size_t i = 0; i < level->size(); ++i) put(next[i / 4], i % 4, around((*level)[i]));
    level = &levels_.emplace_back(std::move(next));
  }
}

void BoxTree::set(std::uint32_t slot, const Box& box) {
  Rounded now = rounded_outwards(box);
  std::size_t at = slot;
  for (std::vector<Four>& level : levels_) {
    Four& four = level[at / 4];
    // All levels above are then unchanged, too.
    if (&level != &levels_.front() && has(four, at % 4, now)) return;
    put(four, at % 4, now);
    now = around(four);
    at /= 4;
  }
}

/// One bit per lane that is set.
unsigned BoxTree::lanes_of(Mask mask) {
  const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(mask & Mask{1, 2, 4, 8});
  const std::uint64_t bits = halves[0] | halves[1];
  return static_cast<unsigned>((bits | bits >> 32) & 15);
}

void BoxTree::find_touching(const Box& box, std::vector<std::uint32_t>& slots) const {
  if (box.empty() || levels_[0].empty()) return;
  struct Place {
    std::uint32_t level;
    std::uint32_t four;
  };
  // At most three wait at each level.
  std::array<Place, 64> waiting;
  std::size_t size = 0;
  waiting[size++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
  const Rounded around = rounded_outwards(box);
  while (size > 0) {
    const auto [level, index] = waiting[--size];
    const Four& four = levels_[level][index];
    Mask apart{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart |= four.lo[axis] > around.hi[axis];
      apart |= four.hi[axis] < around.lo[axis];
    }
    for (unsigned touching = lanes_of(apart) ^ 15U; touching != 0; touching &= touching - 1) {
      const std::uint32_t child =
          4 * index + static_cast<std::uint32_t>(std::countr_zero(touching));
      if (level == 0) {
        slots.push_back(child);
      } else {
        waiting[size++] = {level - 1, child};
      }
    }
  }
}

}  // namespace meshfarm
