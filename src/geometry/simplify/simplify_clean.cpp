// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_clean.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/simplify/fans.hpp"
#include "geometry/simplify/orient.hpp"
#include "geometry/simplify/piece_sets.hpp"

namespace meshfarm {
namespace {

/// The smallest vertex of each pair of triangles with the same vertices, ascending. Such a pair is
/// a fan of its own, so only broken fans and fans of two are checked.
std::vector<std::uint32_t> vertices_with_duplicates(std::span<const std::uint8_t> flags,
                                                    const Adjacency& adjacency) {
  std::vector<std::uint32_t> found;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> others;
  for (std::uint32_t v = 0; v < adjacency.vertices(); ++v) {
    if ((flags[v] & k_still) == 0 && adjacency.count(v) != 2) continue;
    others.clear();
    for (const Corner c : adjacency.at(v)) {
      if (c.next < v || c.prev < v) continue;
      others.emplace_back(std::min(c.next, c.prev), std::max(c.next, c.prev));
    }
    std::sort(others.begin(), others.end());
    if (std::adjacent_find(others.begin(), others.end()) != others.end()) found.push_back(v);
  }
  return found;
}

/// Of the triangles whose smallest vertex is in `vertices`, keeps the first for each set of
/// corners.
std::uint64_t drop_duplicates_at(const std::vector<std::uint32_t>& vertices, Mesh& mesh) {
  std::vector<std::uint8_t> doubtful(mesh.positions.size(), 0);
  for (const std::uint32_t v : vertices) doubtful[v] = 1;
  std::vector<std::pair<Triangle, std::uint32_t>> sets;  // and where in the mesh
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle t = mesh.triangles[i];
    std::sort(t.begin(), t.end());
    if (doubtful[t[0]] != 0) sets.emplace_back(t, i);
  }
  std::sort(sets.begin(), sets.end());
  std::vector<std::uint8_t> repeated(mesh.triangles.size(), 0);
  for (std::size_t i = 1; i < sets.size(); ++i) {
    if (sets[i].first == sets[i - 1].first) repeated[sets[i].second] = 1;
  }
  return keep_triangles(mesh, [&](std::size_t i) { return repeated[i] == 0; });
}

enum class Fan : std::uint8_t { closed, open, broken };

/// Walks round a vertex. Sorting keeps hubs of many thousand triangles cheap.
class FanWalker {
 public:
  Fan walk(std::span<const Corner> corners) {
    return corners.size() <= k_few ? walk_few(corners) : walk_many(corners);
  }

 private:
  static constexpr std::size_t k_few = 16;

  static std::size_t starting_at(std::span<const Corner> corners, std::uint32_t next) {
    std::size_t i = 0;
    while (i < corners.size() && corners[i].next != next) ++i;
    return i;
  }
  static std::size_t ending_at(std::span<const Corner> corners, std::uint32_t prev) {
    std::size_t i = 0;
    while (i < corners.size() && corners[i].prev != prev) ++i;
    return i;
  }

  /// Nearly every vertex has a closed fan, so only this case is worth code without branches.
  static Fan walk_few(std::span<const Corner> corners) {
    const auto size = static_cast<std::uint32_t>(corners.size());
    std::array<std::uint32_t, k_few> after;
    for (std::uint32_t i = 0; i < size; ++i) {
      std::uint32_t found = size;
      for (std::uint32_t j = 0; j < size; ++j)
        found = corners[j].next == corners[i].prev ? j : found;
      after[i] = found;
    }
    std::uint32_t at = 0;
    std::uint32_t steps = 0;
    while (steps < size && at < size && (at != 0 || steps == 0)) {
      at = after[at];
      ++steps;
    }
    if (at == 0) return steps == size ? Fan::closed : Fan::broken;
    return walk_open(corners);
  }

  static Fan walk_open(std::span<const Corner> corners) {
    std::size_t first = 0;
    std::size_t before = 0;
    for (std::size_t steps = 0; steps < corners.size(); ++steps) {
      before = ending_at(corners, corners[first].next);
      if (before == corners.size()) break;
      first = before;
    }
    if (before != corners.size()) return Fan::broken;
    std::size_t at = first;
    for (std::size_t steps = 1; steps < corners.size(); ++steps) {
      at = starting_at(corners, corners[at].prev);
      if (at == corners.size() || at == first) return Fan::broken;
    }
    return starting_at(corners, corners[at].prev) == corners.size() ? Fan::open : Fan::broken;
  }

  Fan walk_many(std::span<const Corner> corners) {
    corners_.assign(corners.begin(), corners.end());
    std::sort(corners_.begin(), corners_.end(), [](Corner a, Corner b) { return a.next < b.next; });
    const bool repeated =
        std::adjacent_find(corners_.begin(), corners_.end(),
                           [](Corner a, Corner b) { return a.next == b.next; }) != corners_.end();
    if (repeated) return Fan::broken;
    prevs_.clear();
    for (const Corner c : corners_) prevs_.push_back(c.prev);
    std::sort(prevs_.begin(), prevs_.end());
    return follow();
  }

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
    if (fan == Fan::broken) flags[v] |= k_complex;
    if (fan == Fan::open) flags[v] |= options.lines.preserve_border ? k_fixed : k_border;
  }
  return flags;
}

/// Whether two triangles at an edge face opposite ways. Such an edge breaks the fans at its ends.
bool any_turned(std::span<const std::uint8_t> flags, const Adjacency& adjacency) {
  FanSplitter splitter;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    if ((flags[v] & k_still) == 0) continue;
    splitter.split(adjacency.at(v));
    if (splitter.has_turned()) return true;
  }
  return false;
}

/// A vertex and a triangle at it.
struct Place {
  std::uint32_t vertex;
  std::uint32_t triangle;
};

/// The triangles at vertices whose triangles are not a single fan, by vertex.
std::vector<Place> places_at_complex(const Mesh& mesh, std::span<const std::uint8_t> flags) {
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if ((flags[v] & k_still) == k_complex) places.push_back({v, i});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& x, const Place& y) { return x.vertex < y.vertex; });
  return places;
}

/// Whether removing the fan would leave a single triangle at one of its edges, as at the foot of a
/// wall on a floor.
bool leaves_a_border(std::span<const Corner> fan, std::span<const Corner> corners,
                     std::vector<std::uint32_t>& ends) {
  ends.clear();
  for (const Corner& c : corners) ends.insert(ends.end(), {c.next, c.prev});
  std::sort(ends.begin(), ends.end());
  const auto is_odd = [&](std::uint32_t end) {
    const auto [first, last] = std::equal_range(ends.begin(), ends.end(), end);
    return (last - first) % 2 != 0;
  };
  return std::any_of(fan.begin(), fan.end(),
                     [&](const Corner& c) { return is_odd(c.next) || is_odd(c.prev); });
}

/// Where a vertex has several fans, gives the closed ones vertices of their own. Returns whether
/// there are any. Works on one vertex after the other: the four triangles at an edge must be paired
/// alike at both of its ends, or a slit opens between them.
bool separate_closed_fans(Mesh& mesh, std::span<const std::uint8_t> flags) {
  FanSplitter splitter;
  FanSplitter single;
  std::vector<Corner> corners;
  std::vector<Corner> fan;
  std::vector<std::uint32_t> ends;
  const std::vector<Place> places = places_at_complex(mesh, flags);
  const std::size_t vertices = mesh.positions.size();
  for (std::size_t first = 0, last = 0; first < places.size(); first = last) {
    const std::uint32_t v = places[first].vertex;
    while (last < places.size() && places[last].vertex == v) ++last;
    const std::span<const Place> at = std::span(places).subspan(first, last - first);
    corners.clear();
    for (const Place& p : at) corners.push_back(corner_at(mesh.triangles[p.triangle], v));
    const std::uint32_t fans = splitter.split(corners);
    for (std::uint32_t f = 1; f < fans; ++f) {
      fan.clear();
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (splitter.fans()[i] == f) fan.push_back(corners[i]);
      }
      if (single.split(fan) != 1 || single.kind() != FanSplitter::Kind::closed) continue;
      if (leaves_a_border(fan, corners, ends)) continue;
      const auto copy = static_cast<std::uint32_t>(mesh.positions.size());
      append_vertex(VertexView(mesh), v, mesh);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        Triangle& t = mesh.triangles[at[i].triangle];
        if (splitter.fans()[i] == f) t[place_of(t, v)] = copy;
      }
    }
  }
  return mesh.positions.size() > vertices;
}

/// Where the topology may change, small pieces simplify better on their own.
bool separates_pieces(const SimplifyOptions& options) {
  return options.lines.crossings == CrossingMode::avoid && options.seam.empty() &&
         options.bound == nullptr && options.lines.topology != TopologyMode::keep;
}

}  // namespace

void check_input(const Mesh& mesh, const SimplifyOptions& options) {
  const std::size_t vertices = mesh.positions.size();
  if (!(options.lines.crease_angle >= 0 && options.lines.crease_angle < 180)) {
    throw UsageError("simplify: the crease angle is not in 0 to 180 degrees");
  }
  if (options.locked_vertices > vertices) {
    throw UsageError("simplify: more locked vertices than the mesh has");
  }
  if (!mesh.appearances.empty() && mesh.appearances.size() != vertices) {
    throw UsageError("simplify: the appearances are not one a vertex");
  }
  const TriangleColumnsView columns = mesh.columns;
  if (!columns.fits(columns.set(), mesh.triangles.size())) {
    throw UsageError("simplify: the columns are not one a triangle");
  }
  if (!options.seam.empty() && options.seam.size() != vertices) {
    throw UsageError("simplify: the seam flags are not one a vertex");
  }
  const auto is_there = [&](std::uint32_t v) { return v < vertices; };
  if (!std::all_of(options.opened.begin(), options.opened.end(), is_there)) {
    throw UsageError("simplify: an opened vertex is not there");
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

Surface clean_surface(Mesh& mesh, const SimplifyOptions& options, Adjacency& adjacency) {
  Surface surface;
  // Usually there are none, and looking for one is cheaper than moving all.
  if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), is_degenerate<std::uint32_t>)) {
    surface.dropped.degenerate =
        keep_triangles(mesh, [&](std::size_t i) { return !is_degenerate(mesh.triangles[i]); });
  }
  adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
  surface.flags = classify_vertices(mesh, options, adjacency);
  const auto again = [&] {
    adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
    surface.flags = classify_vertices(mesh, options, adjacency);
  };
  const std::vector<std::uint32_t> doubtful = vertices_with_duplicates(surface.flags, adjacency);
  if (!doubtful.empty()) {
    surface.dropped.duplicate = drop_duplicates_at(doubtful, mesh);
    again();
  }
  if (any_turned(surface.flags, adjacency)) {
    surface.dropped.turned = orient(mesh);
    if (surface.dropped.turned > 0) again();
  }
  // In a seam pass, the caller's flags are for the given vertices, so none are added.
  if (options.seam.empty() && separate_closed_fans(mesh, surface.flags)) again();
  if (separates_pieces(options) && separate_small_pieces(mesh, surface.flags)) {
    again();
    if (separate_closed_fans(mesh, surface.flags)) again();
  }
  return surface;
}

}  // namespace meshfarm
