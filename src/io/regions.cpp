// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/io/regions.hpp>

namespace meshfarm {
namespace {

/// With fewer regions, a job would spend most of its time opening files.
constexpr std::uint32_t k_least_regions = 4;
constexpr std::uint32_t k_most_groups = 24;

std::uint32_t middle_of(const PartRange& region) {
  return region.first + (region.end - region.first) / 2;
}

void add_touched(const PartRange& region, const std::vector<PartRange>& pieces,
                 std::vector<std::uint32_t>& found) {
  if (region.end - region.first < 2) return;
  const bool is_apart = region.end <= pieces.front().first || region.first >= pieces.back().end;
  const bool is_within = std::any_of(pieces.begin(), pieces.end(), [&](const PartRange& piece) {
    return piece.first <= region.first && region.end <= piece.end;
  });
  if (is_apart || is_within) return;
  const std::uint32_t middle = middle_of(region);
  add_touched({region.first, middle}, pieces, found);
  found.push_back(middle - 1);
  add_touched({middle, region.end}, pieces, found);
}

}  // namespace

std::uint32_t Regions::of(std::uint32_t a, std::uint32_t b) const {
  const auto [least, greatest] = std::minmax(a, b);
  PartRange region{0, std::max(2U, parts_)};
  for (;;) {
    const std::uint32_t middle = middle_of(region);
    PartRange half =
        greatest < middle ? PartRange{region.first, middle} : PartRange{middle, region.end};
    const bool holds_both = half.first <= least && greatest < half.end;
    if (!holds_both || half.end - half.first < 2) return middle - 1;
    region = half;
  }
}

std::vector<std::uint32_t> Regions::touched_by(const std::vector<PartRange>& pieces) const {
  std::vector<std::uint32_t> found;
  if (!pieces.empty()) add_touched({0, parts_}, pieces, found);
  return found;
}

RegionGroups::RegionGroups(std::uint32_t parts)
    : regions_(parts), count_(std::clamp(regions_.count() / k_least_regions, 1U, k_most_groups)) {}

std::uint32_t RegionGroups::first_region(std::uint32_t group) const {
  return static_cast<std::uint32_t>((std::uint64_t{group} * regions_.count() + count_ - 1) /
                                    count_);
}

std::uint32_t RegionGroups::of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const auto [least, greatest] = std::minmax({a, b, c});
  return static_cast<std::uint32_t>(std::uint64_t{regions_.of(least, greatest)} * count_ /
                                    regions_.count());
}

}  // namespace meshfarm
