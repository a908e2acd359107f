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

/// Free boxes below the horizon.
class Gaps {
 public:
  struct Size {
    int width, height;
  };
  /// Boxes with a side below `least` are not kept.
  explicit Gaps(int least) : least_(least) {}
  void add(const Gap& gap);
  std::size_t size() const { return gaps_.size(); }
  /// A corner of the gap that best fits a box of this size; the rest of the gap stays free.
  std::optional<Gap> take(Size size);
  /// How badly the box would fit: lower is better; HUGE_VAL if it does not fit.
  double waste(Size size) const;

 private:
  std::size_t best_for(Size size) const;

  int least_;
  std::vector<Gap> gaps_;
};

/// The top of what lies in each column of a picture.
class Horizon {
 public:
  /// `is_hasty`: for narrow shapes, search only near the lowest part of the horizon.
  Horizon(std::uint32_t side, std::uint32_t column, bool is_hasty);

  struct Spot {
    double score = HUGE_VAL;
    std::size_t column = 0;
    int y = 0;
  };
  /// The best spot for the shape; its score is infinite if the shape does not fit.
  Spot best_spot(const Profile& shape);
  /// Places the shape there. Space that it closes off from above is added to the gaps.
  void put(const Profile& shape, const Spot& spot, Gaps& gaps);

 private:
  static constexpr std::size_t k_block = 16;   // columns that share a minimum
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
  std::vector<Height> rest_;    // height at which a shape would lie, per first column
};

}  // namespace meshfarm
