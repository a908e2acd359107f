// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify_clean.hpp"

#include <algorithm>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

bool is_degenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// The first `n` triangles that `keep` accepts, in order.
template <typename Keep>
std::uint64_t drop_unless(std::vector<Triangle>& triangles, const Keep& keep) {
  const auto last = std::remove_if(triangles.begin(), triangles.end(),
                                   [&](const Triangle& t) { return !keep(t); });
  const auto dropped = static_cast<std::uint64_t>(triangles.end() - last);
  triangles.erase(last, triangles.end());
  return dropped;
}

enum class Fan : std::uint8_t { closed, open, broken };

/// Walks round a vertex. Sorting keeps hubs of many thousand triangles cheap.
class FanWalker {
 public:
  Fan walk(std::span<const Corner> corners) {
    corners_.assign(corners.begin(), corners.end());
    std::sort(corners_.begin(), corners_.end(),
              [](Corner a, Corner b) { return a.next < b.next; });
    const bool repeated = std::adjacent_find(corners_.begin(), corners_.end(), [](Corner a, Corner b) {
                            return a.next == b.next;
                          }) != corners_.end();
    if (repeated) return Fan::broken;
    prevs_.clear();
    for (const Corner c : corners_) prevs_.push_back(c.prev);
    std::sort(prevs_.begin(), prevs_.end());
    return follow();
  }

 private:
  // With distinct nexts each corner has at most one successor: the one that begins where it ends.
  const Corner* starting_at(std::uint32_t next) const {
    const auto at = std::lower_bound(corners_.begin(), corners_.end(), next,
                                     [](Corner c, std::uint32_t v) { return c.next < v; });
    return at != corners_.end() && at->next == next ? &*at : nullptr;
  }

  Fan follow() const {
    const Corner* first = nullptr;
    for (const Corner& c : corners_) {
      if (std::binary_search(prevs_.begin(), prevs_.end(), c.next)) continue;
      if (first != nullptr) return Fan::broken;
      first = &c;
    }
    const bool open = first != nullptr;
    if (!open) first = corners_.data();
    const Corner* at = first;
    for (std::size_t steps = 1; steps < corners_.size(); ++steps) {
      at = starting_at(at->prev);
      if (at == nullptr || at == first) return Fan::broken;
    }
    const Corner* after = starting_at(at->prev);
    if (open) return after == nullptr ? Fan::open : Fan::broken;
    return after == first ? Fan::closed : Fan::broken;
  }

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> prevs_;
};

}  // namespace

void check_input(const Mesh& mesh, const SimplifyOptions& options) {
  const std::size_t vertices = mesh.positions.size();
  if (options.locked_vertices > vertices) {
    throw UsageError("simplify: more locked vertices than the mesh has");
  }
  if (!options.seam.empty() && options.seam.size() != vertices) {
    throw UsageError("simplify: the seam flags are not one a vertex");
  }
  constexpr std::size_t k_limit = UINT32_MAX / 3 - 1;
  if (vertices > k_limit || mesh.triangles.size() > k_limit) {
    throw UsageError("simplify: the mesh is too big for 32-bit indices; cut it into parts");
  }
  for (const Triangle& t : mesh.triangles) {
    if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices) {
      throw DataError("simplify: a triangle names a vertex that does not exist");
    }
  }
}

Dropped drop_bad_triangles(Mesh& mesh, Adjacency& adjacency) {
  Dropped dropped;
  dropped.degenerate =
      drop_unless(mesh.triangles, [](const Triangle& t) { return !is_degenerate(t); });

  // A triangle is looked for among those at its smallest vertex; rows are in triangle order, so
  // the k-th corner of a row that has this smallest vertex belongs to the k-th such triangle.
  adjacency.build(mesh.triangles, mesh.positions.size());
  std::vector<std::uint8_t> repeats(mesh.triangles.size(), 0);
  struct Pair {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t rank;
  };
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> seen(mesh.positions.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) ++seen[std::min({t[0], t[1], t[2]}) + 1];
  for (std::size_t v = 1; v < seen.size(); ++v) seen[v] += seen[v - 1];
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    pairs.clear();
    for (const Corner c : adjacency.at(v)) {
      if (c.next < v || c.prev < v) continue;
      pairs.push_back({std::min(c.next, c.prev), std::max(c.next, c.prev),
                       static_cast<std::uint32_t>(pairs.size())});
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return std::tie(a.low, a.high, a.rank) < std::tie(b.low, b.high, b.rank);
    });
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      const bool same = pairs[i].low == pairs[i - 1].low && pairs[i].high == pairs[i - 1].high;
      if (same) repeats[seen[v] + pairs[i].rank] = 1;
    }
  }
  dropped.duplicate = drop_unless(mesh.triangles, [&](const Triangle& t) {
    return repeats[seen[std::min({t[0], t[1], t[2]})]++] == 0;
  });
  return dropped;
}

std::vector<std::uint8_t> classify_vertices(const Mesh& mesh, const SimplifyOptions& options,
                                            const Adjacency& adjacency) {
  std::vector<std::uint8_t> flags(mesh.positions.size(), 0);
  FanWalker walker;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    const bool locked = v < options.locked_vertices;
    if (locked || !is_finite(mesh.positions[v])) flags[v] |= k_fixed;
    if (!options.seam.empty() && options.seam[v] != 0) flags[v] |= k_seam;
    if (adjacency.count(v) == 0) continue;
    const Fan fan = walker.walk(adjacency.at(v));
    if (fan == Fan::broken) flags[v] |= k_fixed;
    if (fan == Fan::open) flags[v] |= k_border;
  }
  return flags;
}

}  // namespace meshfarm
