// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The sample is all vertices in some cells of a grid, chosen by a hash: so vertices that belong
// together are mostly in it together.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <meshfarm/geometry/near_misses.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_most_sampled = 100'000;
constexpr std::uint64_t k_cells_of_sample = 1024;  // along the diagonal
/// A distance at which corners are merged, in units of the greatest distance to a next one: several
/// corners that belong together are farther apart than each is from its next.
constexpr double k_wide = 4;
/// No places may be farther apart than the nearest ones, up to this many times as far.
constexpr double k_empty_gap = 16;
/// Places that are very near others, of all; and of those, places that contradict.
constexpr double k_share_near = 0.01;
constexpr double k_share_against = 0.01;
/// Distances that are tried as the limit of what is very near: each a quarter of the one before.
constexpr int k_near_limits = 8;
/// With more, most of the mesh is in a few cells, as with a vertex far away from all others.
constexpr std::uint64_t k_most_looks = 4'000'000;
constexpr unsigned k_most_thinned = 40;

/// Its high bits are the better ones. All coordinates are from 0 to k_cells_of_sample.
std::uint64_t hash_of_cell(Vec3 at) {
  constexpr std::uint64_t k_row = k_cells_of_sample + 1;
  const auto x = static_cast<std::uint32_t>(at.x);
  const auto y = static_cast<std::uint32_t>(at.y);
  const auto z = static_cast<std::uint32_t>(at.z);
  return ((x * k_row + y) * k_row + z + 1) * 0x9e3779b97f4a7c15U;
}

bool is_left_out(std::uint64_t cell, unsigned thinned) {
  return thinned > 0 && cell >> (64 - thinned) != 0;
}

}  // namespace

NearMisses::NearMisses(const Box& box) : corner_(box.lo), diagonal_(box.diagonal()) {}

void NearMisses::add(std::span<const Vec3> batch) {
  if (!(diagonal_ > 0) || !std::isfinite(diagonal_)) return;
  const double scale = k_cells_of_sample / diagonal_;
  for (const Vec3& p : batch) {
    const std::uint64_t vertex = vertices_++;
    if (!has_position(p)) continue;
    const std::uint64_t cell = hash_of_cell((p - corner_) * scale);
    if (is_left_out(cell, thinned_)) continue;
    sample_.push_back({p, cell, vertex});
    if (sample_.size() > k_most_sampled) thin_out();
  }
}

void NearMisses::thin_out() {
  while (sample_.size() > k_most_sampled && thinned_ < k_most_thinned) {
    ++thinned_;
    std::erase_if(sample_, [&](const Sampled& s) { return is_left_out(s.cell, thinned_); });
  }
}

void NearMisses::number_places() {
  const auto key = [](const Sampled& s) {
    return std::tuple(s.cell, s.position.x, s.position.y, s.position.z, s.vertex);
  };
  std::sort(sample_.begin(), sample_.end(),
            [&](const Sampled& a, const Sampled& b) { return key(a) < key(b); });
  places_.clear();
  for (std::uint32_t i = 0; i < sample_.size(); ++i) {
    const bool is_new = i == 0 || sample_[i].cell != sample_[i - 1].cell ||
                        sample_[i].position != sample_[i - 1].position;
    if (is_new) places_.push_back(i);
  }
}

template <class Take>
bool NearMisses::for_neighbours(double most, Take take) const {
  std::uint64_t looks = 0;
  for (std::uint32_t i = 0; i < places_.size(); ++i) {
    const Sampled& a = sample_[places_[i]];
    for (std::uint32_t j = i + 1; j < places_.size(); ++j) {
      const Sampled& b = sample_[places_[j]];
      if (b.cell != a.cell || b.position.x - a.position.x > most) break;
      if (++looks > k_most_looks) return false;
      const double apart = length(b.position - a.position);
      if (apart <= most) take(i, j, apart);
    }
  }
  return true;
}

bool NearMisses::look() {
  number_places();
  const double most = k_most_of_diagonal / k_wide * diagonal_;
  std::vector<double> next(places_.size(), std::numeric_limits<double>::infinity());
  const bool has_seen_all =
      for_neighbours(k_empty_gap * most, [&](std::uint32_t a, std::uint32_t b, double apart) {
        next[a] = std::min(next[a], apart);
        next[b] = std::min(next[b], apart);
      });
  if (!has_seen_all) return false;
  std::sort(next.begin(), next.end());
  const auto up_to = [&](double distance) {
    return static_cast<std::size_t>(std::upper_bound(next.begin(), next.end(), distance) -
                                    next.begin());
  };
  for (double limit = most; limit > most * std::pow(0.25, k_near_limits); limit /= 4) {
    const std::size_t near = up_to(limit);
    const auto between = static_cast<double>(up_to(k_empty_gap * limit) - near);
    if (static_cast<double>(near) < k_share_near * static_cast<double>(places_.size())) break;
    if (near == 0 || between > k_share_against * static_cast<double>(near)) continue;
    near_ = next[near - 1];
    list_pairs();
    return true;
  }
  return false;
}

void NearMisses::list_pairs() {
  for_neighbours(k_wide * near_, [&](std::uint32_t a, std::uint32_t b, double) {
    pairs_.push_back({a, b});
  });
  std::vector<bool> is_in_pair(places_.size());
  for (const Pair& pair : pairs_) is_in_pair[pair.a] = is_in_pair[pair.b] = true;
  for (std::uint32_t i = 0; i < places_.size(); ++i) {
    if (!is_in_pair[i]) continue;
    const std::size_t end = i + 1 < places_.size() ? places_[i + 1] : sample_.size();
    for (std::size_t s = places_[i]; s < end; ++s) place_of_.emplace(sample_[s].vertex, i);
  }
}

void NearMisses::add(std::span<const std::array<std::uint64_t, 3>> triangles) {
  constexpr std::uint32_t k_no_place = UINT32_MAX;
  const auto place_of = [&](std::uint64_t vertex) {
    const auto found = place_of_.find(vertex);
    return found == place_of_.end() ? k_no_place : found->second;
  };
  for (const auto& t : triangles) {
    const std::array at{place_of(t[0]), place_of(t[1]), place_of(t[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = at[i];
      const std::uint32_t b = at[(i + 1) % 3];
      if (a != k_no_place && b != k_no_place && a != b) join(std::min(a, b), std::max(a, b));
    }
  }
}

void NearMisses::join(std::uint32_t a, std::uint32_t b) {
  const auto found = std::lower_bound(
      pairs_.begin(), pairs_.end(), std::pair(a, b),
      [](const Pair& pair, const auto& wanted) { return std::pair(pair.a, pair.b) < wanted; });
  if (found != pairs_.end() && found->a == a && found->b == b) found->has_triangle = true;
}

double NearMisses::distance() const {
  const auto joined = static_cast<double>(
      std::count_if(pairs_.begin(), pairs_.end(), [](const Pair& p) { return p.has_triangle; }));
  return joined > k_share_against * static_cast<double>(pairs_.size()) ? 0 : k_wide * near_;
}

}  // namespace meshfarm
