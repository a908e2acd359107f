// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/texture/atlas_profile.hpp"

namespace meshfarm {

/// A free box, in texels.
struct Gap {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Boxes that are free below what lies on the horizon.
class Gaps {
 public:
  struct Size {
    int width, height;
  };
  /// Boxes with a side below `least` are not kept.
  explicit Gaps(int least) : least_(least) {}
  void add(const Gap& gap);
  std::size_t size() const { return gaps_.size(); }
  /// A corner of the gap that a box of this size fits best; what is left of it stays free.
  std::optional<Gap> take(Size size);
  /// How well the box would fit: the lower the better; HUGE_VAL if it does not.
  double waste(Size size) const;

 private:
  std::size_t best_for(Size size) const;

  int least_;
  std::vector<Gap> gaps_;
};

/// The top of what lies in each column of a picture.
class Horizon {
 public:
  /// Hasty: narrow shapes are looked for only round where the horizon is lowest.
  Horizon(std::uint32_t side, std::uint32_t column, bool is_hasty);

  struct Spot {
    double score = HUGE_VAL;
    std::size_t column = 0;
    int y = 0;
  };
  /// Where the shape lies best; its score is infinite if it does not fit.
  Spot best_spot(const Profile& shape);
  /// Puts it there. What it shuts off from above goes to the gaps.
  void put(const Profile& shape, const Spot& spot, Gaps& gaps);

 private:
  static constexpr std::size_t k_block = 16;   // columns of which the lowest is known
  static constexpr std::size_t k_window = 64;  // columns

  void set_block(std::size_t block);
  std::size_t lowest_block() const;
  Spot best_between(const Profile& shape, std::size_t begin, std::size_t end);
  void add_gaps(const Profile& shape, const Spot& spot, Gaps& gaps) const;

  int side_;
  int column_;
  bool is_hasty_;
  std::vector<Height> top_;
  std::vector<Height> blocks_;  // the lowest of each
  std::vector<Height> rest_;    // where a shape would lie, for each first column
};

}  // namespace meshfarm
