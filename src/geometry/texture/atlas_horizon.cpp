// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/atlas_horizon.hpp"

#include <algorithm>
#include <numeric>

namespace meshfarm {

void Gaps::add(const Gap& gap) {
  if (std::min(gap.width, gap.height) >= least_) gaps_.push_back(gap);
}

std::size_t Gaps::best_for(Size size) const {
  std::size_t best = gaps_.size();
  int least = 0;
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    const int wide = gaps_[i].width - size.width, high = gaps_[i].height - size.height;
    if (wide < 0 || high < 0) continue;
    const int left = std::min(wide, high);
    if (best < gaps_.size() && left >= least) continue;
    best = i;
    least = left;
  }
  return best;
}

double Gaps::waste(Size size) const {
  const std::size_t i = best_for(size);
  if (i == gaps_.size()) return HUGE_VAL;
  return std::min(gaps_[i].width - size.width, gaps_[i].height - size.height);
}

std::optional<Gap> Gaps::take(Size size) {
  const std::size_t i = best_for(size);
  if (i == gaps_.size()) return {};
  const Gap gap = gaps_[i];
  gaps_[i] = gaps_.back();
  gaps_.pop_back();
  const auto [width, height] = size;
  const int wide = gap.width - width, high = gap.height - height;
  // Keep the larger of the two remainders whole.
  const bool is_beside = wide > high;
  add({gap.x + width, gap.y, wide, is_beside ? gap.height : height});
  add({gap.x, gap.y + height, is_beside ? width : gap.width, high});
  return Gap{gap.x, gap.y, width, height};
}

Horizon::Horizon(std::uint32_t side, std::uint32_t column, bool is_hasty)
    : side_(static_cast<int>(side)),
      column_(static_cast<int>(column)),
      is_hasty_(is_hasty),
      top_(side / column, 0),
      blocks_((top_.size() + k_block - 1) / k_block, 0),
      rest_(top_.size()) {}

Horizon::Spot Horizon::best_spot(const Profile& shape) {
  const std::size_t width = shape.low.size();
  if (width > top_.size()) return {};
  const std::size_t places = top_.size() - width + 1;
  if (is_hasty_ && 2 * width < k_window && places > 2 * k_window) {
    const std::size_t lowest = lowest_block() * k_block;
    const std::size_t begin = std::min(lowest - std::min(lowest, k_window / 2), places - k_window);
    const Spot spot = best_between(shape, begin, begin + k_window);
    if (spot.score < HUGE_VAL) return spot;
  }
  return best_between(shape, 0, places);
}

/// The best spot with a first column from `begin` to `end`.
Horizon::Spot Horizon::best_between(const Profile& shape, std::size_t begin, std::size_t end) {
  const std::size_t width = shape.low.size();
  const std::size_t places = end - begin;
  std::fill_n(rest_.begin(), places, Height{0});
  for (std::size_t c = 0; c < width; ++c) {
    const Height* top = top_.data() + begin + c;
    const Height low = shape.low[c];
    Height* rest = rest_.data();
    for (std::size_t x = 0; x < places; ++x) {
      const auto y = static_cast<Height>(top[x] - low);
      rest[x] = rest[x] < y ? y : rest[x];
    }
  }
  const Height* first = top_.data() + begin;
  long below = std::accumulate(first, first + width, 0L);
  const double columns = static_cast<double>(width);
  Spot best;
  for (std::size_t x = 0; x < places; ++x) {
    const int y = rest_[x];
    if (y + shape.top <= side_) {
      // Prefer low spots, and little wasted room below, averaged over the columns.
      const double lost = static_cast<double>(shape.low_sum - below) / columns + y;
      const double score = y + shape.top + 0.5 * lost;
      if (score < best.score) best = {score, begin + x, y};
    }
    if (x + 1 < places) below += first[x + width] - first[x];
  }
  return best;
}

void Horizon::put(const Profile& shape, const Spot& spot, Gaps& gaps) {
  add_gaps(shape, spot, gaps);
  for (std::size_t c = 0; c < shape.high.size(); ++c) {
    top_[spot.column + c] = static_cast<Height>(spot.y + shape.high[c]);
  }
  const std::size_t end = spot.column + shape.high.size();
  for (std::size_t b = spot.column / k_block; b * k_block < end; ++b) set_block(b);
}

/// Adds the gaps between the horizon and the shape: the largest box, then those at its sides.
void Horizon::add_gaps(const Profile& shape, const Spot& spot, Gaps& gaps) const {
  struct Columns {
    std::size_t begin, end;
  };
  std::vector<Columns> open{{0, shape.low.size()}};
  while (!open.empty()) {
    const Columns now = open.back();
    open.pop_back();
    Gap best;
    Columns of_best{};
    for (std::size_t first = now.begin; first < now.end; ++first) {
      int bottom = 0, top = side_;
      for (std::size_t c = first; c < now.end; ++c) {
        bottom = std::max<int>(bottom, top_[spot.column + c]);
        top = std::min<int>(top, spot.y + shape.low[c]);
        if (top <= bottom) break;
        const int width = static_cast<int>(c + 1 - first) * column_;
        if (long{width} * (top - bottom) <= long{best.width} * best.height) continue;
        best = {static_cast<int>(spot.column + first) * column_, bottom, width, top - bottom};
        of_best = {first, c + 1};
      }
    }
    const std::size_t before = gaps.size();
    gaps.add(best);
    if (gaps.size() == before) continue;
    open.push_back({now.begin, of_best.begin});
    open.push_back({of_best.end, now.end});
  }
}

void Horizon::set_block(std::size_t block) {
  const std::size_t begin = block * k_block;
  const std::size_t end = std::min(top_.size(), begin + k_block);
  blocks_[block] = *std::min_element(top_.begin() + static_cast<std::ptrdiff_t>(begin),
                                     top_.begin() + static_cast<std::ptrdiff_t>(end));
}

std::size_t Horizon::lowest_block() const {
  return static_cast<std::size_t>(std::min_element(blocks_.begin(), blocks_.end()) -
                                  blocks_.begin());
}

}  // namespace meshfarm
