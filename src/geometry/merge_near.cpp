// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Positions are visited cell by cell of a grid, in the order of the cells' hashes. One that has no
// centre within the distance becomes a centre; in the end, each takes its nearest centre. If cells
// were visited along an axis, what becomes of a position could depend on a long chain of others.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>

#include <meshfarm/geometry/merge_near.hpp>
#include <meshfarm/geometry/place_hash.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_centre = std::numeric_limits<std::uint32_t>::max();

/// Cells whose side is a multiple of the distance: large enough that a ball rarely touches several,
/// and never more than two along an axis, small enough that a cell has few centres.
class MergeCells {
 public:
  explicit MergeCells(double distance)
      : distance_(distance), per_side_(1 / (k_cell_side * distance)) {}

  /// The hash of a position's cell.
  std::uint64_t at(Vec3 p) const { return hash_of(PlaceKey({cell(p.x), cell(p.y), cell(p.z)})); }
  /// Calls take(hash) for each cell that may have positions within the distance.
  template <class Take>
  void around(Vec3 p, Take take) const {
    const std::array xs{cell(p.x - distance_), cell(p.x + distance_)};
    const std::array ys{cell(p.y - distance_), cell(p.y + distance_)};
    const std::array zs{cell(p.z - distance_), cell(p.z + distance_)};
    const int last_x = xs[0] != xs[1] ? 1 : 0;
    const int last_y = ys[0] != ys[1] ? 1 : 0;
    const int last_z = zs[0] != zs[1] ? 1 : 0;
    for (int x = 0; x <= last_x; ++x) {
      for (int y = 0; y <= last_y; ++y) {
        for (int z = 0; z <= last_z; ++z) take(hash_of(PlaceKey({xs[x], ys[y], zs[z]})));
      }
    }
  }

 private:
  static constexpr double k_cell_side = 8;
  double cell(double x) const { return std::floor(x * per_side_); }

  double distance_;
  double per_side_;
};

/// Positions that others become, in a hash table of cells. Cells that share a slot only cost time.
class MergeCentres {
 public:
  MergeCentres(const MergeCells& cells, std::size_t positions, double distance)
      : cells_(cells),
        distance_(distance),
        shift_(64 - static_cast<int>(std::bit_width(positions + 1))),
        heads_(std::size_t{1} << (64 - shift_), k_no_centre) {}

  /// The nearest one within the distance, of several the first; or k_no_centre.
  std::uint32_t nearest(Vec3 p) const {
    std::uint32_t found = k_no_centre;
    double least = distance_ * distance_;
    cells_.around(p, [&](std::uint64_t hash) {
      for (std::uint32_t at = heads_[hash >> shift_]; at != k_no_centre; at = centres_[at].next) {
        const double square = squared_length(centres_[at].position - p);
        if (square < least || (square == least && at < found)) {
          least = square;
          found = at;
        }
      }
    });
    return found;
  }
  void add(Vec3 p, std::uint32_t index) {
    std::uint32_t& head = heads_[cells_.at(p) >> shift_];
    centres_.push_back({p, index, head});
    head = static_cast<std::uint32_t>(centres_.size() - 1);
  }
  std::uint32_t index_of(std::uint32_t centre) const { return centres_[centre].index; }

 private:
  struct Centre {
    Vec3 position;
    std::uint32_t index = 0;
    std::uint32_t next = k_no_centre;  // in the slot
  };

  const MergeCells& cells_;
  double distance_;
  int shift_;
  std::vector<std::uint32_t> heads_;
  std::vector<Centre> centres_;
};

struct Placed {
  Vec3 position;
  std::uint32_t index = 0;
};

/// All positions by cells, in each of them by coordinates: equal ones follow each other.
std::vector<Placed> by_cells(std::span<const Vec3> positions, const MergeCells& cells) {
  struct Member {
    std::uint64_t cell = 0;  // its hash
    std::uint32_t index = 0;
  };
  std::vector<Member> members(positions.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i] = {cells.at(positions[i]), i};
  std::sort(members.begin(), members.end(),
            [](const Member& a, const Member& b) { return a.cell < b.cell; });
  std::vector<Placed> all;
  all.reserve(members.size());
  for (const Member& m : members) all.push_back({positions[m.index], m.index});
  const auto key = [](const Placed& p) {
    return std::tuple(p.position.x, p.position.y, p.position.z, p.index);
  };
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    while (last < all.size() && members[last].cell == members[first].cell) ++last;
    std::sort(all.data() + first, all.data() + last,
              [&](const Placed& a, const Placed& b) { return key(a) < key(b); });
  }
  return all;
}

}  // namespace

std::vector<std::uint32_t> merge_near(std::span<const Vec3> positions, double distance) {
  assert(positions.size() < k_no_centre);
  assert(distance > 0 && std::isfinite(distance));
  const MergeCells cells(distance);
  const std::vector<Placed> placed = by_cells(positions, cells);
  MergeCentres centres(cells, positions.size(), distance);
  std::vector<std::uint32_t> taken(positions.size(), k_no_centre);
  const auto is_repeated = [&](std::size_t i) {
    return i > 0 && placed[i].position == placed[i - 1].position;
  };
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const auto& [p, index] = placed[i];
    if (is_repeated(i) || centres.nearest(p) != k_no_centre) continue;
    centres.add(p, index);
    taken[index] = index;
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const auto& [p, index] = placed[i];
    if (is_repeated(i)) {
      taken[index] = taken[placed[i - 1].index];
    } else if (taken[index] == k_no_centre) {
      taken[index] = centres.index_of(centres.nearest(p));
    }
  }
  return taken;
}

}  // namespace meshfarm
