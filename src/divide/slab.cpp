// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/vertices.hpp>

#include "divide/seam_vertices.hpp"
#include "divide/sort_with_columns.hpp"
#include "divide/vertex_sort.hpp"
#include "divide/weld_share.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_slab = std::numeric_limits<std::uint32_t>::max();

/// Sorts a slab by the steps of run().
class SlabSorter {
 public:
  SlabSorter(MeshShare raw, const Sorting& sorting) : raw_(std::move(raw)), sorting_(sorting) {
    slab_.stream.positions = raw_.type;
  }

  SortedSlab run() {
    rank_vertices();
    rank_triangles();
    mark_boundary();
    number_vertices();
    sort_triangles();
    return std::move(slab_);
  }

 private:
  /// The rank of each raw vertex; welded ones share it. Positions are by rank from now on.
  void rank_vertices() {
    std::vector<std::uint32_t> sorted = sorted_vertices(raw_.positions, sorting_.order, raw_.type);
    const std::vector<std::uint32_t> first = weld_sorted(sorted);
    if (!first.empty()) order_touching(sorted, first);
    const std::size_t count = raw_.positions.size();
    rank_.resize(count);
    std::vector<Vec3>& positions = slab_.stream.mesh.positions;
    positions.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t raw = sorted.empty() ? static_cast<std::uint32_t>(i) : sorted[i];
      if (!first.empty() && first[raw] != raw) {
        rank_[raw] = rank_[first[raw]];
        if (!raw_.appearances.empty()) {
          Appearance& of_one = slab_.stream.mesh.appearances[rank_[raw]];
          of_one = std::min(of_one, raw_.appearances[raw]);
        }
        continue;
      }
      rank_[raw] = static_cast<std::uint32_t>(positions.size());
      append_vertex({raw_.positions, raw_.appearances}, raw, slab_.stream.mesh);
    }
    raw_.appearances = {};
    slab_.merged_vertices = count - positions.size();
    raw_.positions = {};
  }

  /// For each vertex its lowest twin, which the sort has put before it; empty if none has any.
  std::vector<std::uint32_t> weld_sorted(std::span<const std::uint32_t> sorted) {
    if (sorting_.weld == Weld::off) return {};
    const auto at = [&](std::size_t i) {
      return sorted.empty() ? static_cast<std::uint32_t>(i) : sorted[i];
    };
    const std::vector<Vec3>& positions = raw_.positions;
    WeldResult welded;
    for (std::size_t i = 1; i < positions.size(); ++i) {
      if (!(positions[at(i - 1)] == positions[at(i)])) continue;
      if (welded.merged++ == 0) {
        welded.first.resize(positions.size());
        std::iota(welded.first.begin(), welded.first.end(), 0U);
      }
      welded.first[at(i)] = welded.first[at(i - 1)];
    }
    static_cast<WeldCounts&>(slab_) = keep_apart(raw_, welded);
    return std::move(welded.first);
  }

  /// The least of a vertex's triangles, given by the positions of its other two corners.
  struct Star {
    Vec3 next = k_no_position;
    Vec3 prev = k_no_position;
  };

  /// Coincident vertices that were not welded because surfaces touch there are put in an order that
  /// does not depend on the input's: by their sheets, or by their least triangles, which differ.
  void order_touching(std::vector<std::uint32_t>& sorted, std::span<const std::uint32_t> first) {
    const std::vector<Vec3>& positions = raw_.positions;
    const auto at = [&](std::size_t i) {
      return sorted.empty() ? static_cast<std::uint32_t>(i) : sorted[i];
    };
    std::vector<std::pair<std::size_t, std::size_t>> places;  // ranges of `sorted`
    for (std::size_t begin = 0, end = 0; begin < positions.size(); begin = end) {
      bool touch = false;
      for (; end < positions.size() && positions[at(begin)] == positions[at(end)]; ++end) {
        touch = touch || first[at(end)] != first[at(begin)];
      }
      if (touch) places.emplace_back(begin, end);
    }
    if (places.empty()) return;
    if (sorted.empty()) {
      sorted.resize(positions.size());
      std::iota(sorted.begin(), sorted.end(), 0U);
    }
    const std::vector<Star> stars = least_stars(sorted, places, first);
    for (const auto& [begin, end] : places) {
      std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                       sorted.begin() + static_cast<std::ptrdiff_t>(end),
                       [&](std::uint32_t a, std::uint32_t b) {
                         const std::uint32_t sheet = sheet_of(a, raw_.apart);
                         if (sheet != k_no_sheet) return sheet < sheet_of(b, raw_.apart);
                         return is_less(stars[star_[first[a]]], stars[star_[first[b]]]);
                       });
    }
    star_ = {};
  }

  std::vector<Star> least_stars(std::span<const std::uint32_t> sorted,
                                std::span<const std::pair<std::size_t, std::size_t>> places,
                                std::span<const std::uint32_t> first) {
    std::vector<Star> stars;
    star_.assign(first.size(), k_no_slab);
    for (const auto& [begin, end] : places) {
      for (const std::uint32_t v : sorted.subspan(begin, end - begin)) {
        if (star_[first[v]] != k_no_slab) continue;
        star_[first[v]] = static_cast<std::uint32_t>(stars.size());
        stars.emplace_back();
      }
    }
    for (const Triangle& t : raw_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t number = star_[first[t[i]]];
        if (number == k_no_slab) continue;
        const Star star{raw_.positions[t[(i + 1) % 3]], raw_.positions[t[(i + 2) % 3]]};
        if (is_less(star, stars[number])) stars[number] = star;
      }
    }
    return stars;
  }

  /// No triangle at all is greatest.
  bool is_less(const Star& a, const Star& b) const {
    if (!has_position(a.next) || !has_position(b.next)) return has_position(a.next);
    if (!(a.next == b.next)) return sorting_.order.before(a.next, b.next);
    return sorting_.order.before(a.prev, b.prev);
  }

  /// Triangles by rank, the smallest corner first, without degenerate ones.
  void rank_triangles() {
    slab_.dropped_degenerate = keep_triangles(raw_.triangles, raw_.columns, [&](std::size_t i) {
      Triangle& t = raw_.triangles[i];
      t = {rank_[t[0]], rank_[t[1]], rank_[t[2]]};
      if (t[1] < t[0] && t[1] < t[2]) {
        t = {t[1], t[2], t[0]};
        turn_columns(i, 1);
      } else if (t[2] < t[0] && t[2] < t[1]) {
        t = {t[2], t[0], t[1]};
        turn_columns(i, 2);
      }
      return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    });
    // If nothing was welded, only the dropped triangles are known, and only these have coincident
    // corners.
    slab_.coincident_corners = std::max(slab_.coincident_corners, slab_.dropped_degenerate);
  }

  /// Turns the columns after the corner at index `corners` has become the triangle's first.
  void turn_columns(std::size_t triangle, int corners) {
    if (raw_.columns.uvs.empty()) return;
    CornerUvs& uvs = raw_.columns.uvs[triangle];
    std::rotate(uvs.begin(), uvs.begin() + corners, uvs.end());
  }

  void mark_boundary() {
    flags_.assign(slab_.stream.mesh.positions.size(), 0);
    for (const std::uint32_t raw : raw_.boundary) flags_[rank_[raw]] = k_boundary;
    for (const Triangle& t : raw_.triangles) {
      for (const std::uint32_t v : t) flags_[v] |= k_used;
    }
  }

  /// Closes the gaps that unused vertices leave.
  void number_vertices() {
    StreamMesh& stream = slab_.stream;
    std::vector<std::uint32_t> number(flags_.size(), k_no_slab);
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < flags_.size(); ++v) {
      if (flags_[v] == 0) continue;
      const bool is_boundary = (flags_[v] & k_boundary) != 0;
      if (is_boundary) ++slab_.boundary_vertices;
      put_vertex(VertexView(stream.mesh), v, stream.mesh, kept);
      stream.boundary.push_back(is_boundary ? 1 : 0);
      number[v] = kept++;
    }
    resize_vertices(stream.mesh, kept);
    renumber_corners(raw_.triangles, number);
  }

  /// Counting sort by the smallest vertex; the few triangles of each are sorted separately.
  void sort_triangles() {
    std::vector<Triangle>& from = raw_.triangles;
    std::vector<Triangle>& to = slab_.stream.mesh.triangles;
    if (!raw_.columns.empty()) {
      sort_with_columns(from, raw_.columns);
      slab_.stream.mesh.columns = std::move(raw_.columns);
    }
    if (std::is_sorted(from.begin(), from.end())) {
      to = std::move(from);
      return;
    }
    std::vector<std::uint32_t> start(slab_.stream.mesh.positions.size() + 1, 0);
    for (const Triangle& t : from) ++start[t[0] + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    to.resize(from.size());
    for (const Triangle& t : from) to[start[t[0]]++] = t;
    from = {};
    for (std::size_t first = 0, last = 0; first < to.size(); first = last) {
      while (last < to.size() && to[last][0] == to[first][0]) ++last;
      std::sort(to.begin() + static_cast<std::ptrdiff_t>(first),
                to.begin() + static_cast<std::ptrdiff_t>(last));
    }
  }

  static constexpr std::uint8_t k_used = 1;
  static constexpr std::uint8_t k_boundary = 2;
  MeshShare raw_;
  const Sorting& sorting_;
  SortedSlab slab_;
  std::vector<std::uint32_t> rank_;
  std::vector<std::uint32_t> star_;  // number of a vertex's star where surfaces touch
  std::vector<std::uint8_t> flags_;  // by rank
};

/// The range of the second coordinate that holds `share` of the vertices, at a place that depends
/// on `number`: multiples of the golden ratio are spread evenly.
std::pair<double, double> sample_range(const std::vector<Vec3>& positions, int axis, double share,
                                       std::uint32_t number) {
  constexpr std::size_t k_looked_at = 8192;
  constexpr double k_golden = 0.6180339887498949;
  const std::size_t step = std::max<std::size_t>(1, positions.size() / k_looked_at);
  std::vector<double> values;
  for (std::size_t i = 0; i < positions.size(); i += step) values.push_back(positions[i][axis]);
  std::sort(values.begin(), values.end());
  const double from = std::fmod((number + 0.5) * k_golden, 1.0) * (1 - share);
  const auto value_at = [&](double quantile) {
    const double last = static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::clamp(quantile * last, 0.0, last))];
  };
  return {value_at(from), value_at(from + share)};
}

}  // namespace

SortedSlab sort_slab(MeshShare raw, const Sorting& sorting) {
  return SlabSorter(std::move(raw), sorting).run();
}

std::uint64_t sample_size(std::uint64_t stream_triangles) {
  constexpr std::uint64_t k_sample_part = 20;       // of a stream
  constexpr std::uint64_t k_least_sample = 60'000;  // the minimum to be meaningful
  return std::max(k_least_sample, stream_triangles / k_sample_part);
}

Part sample_slab(const StreamMesh& stream, const SweepOrder& order, std::uint32_t number) {
  const Mesh& mesh = stream.mesh;
  const double share =
      std::min(1.0, static_cast<double>(sample_size(mesh.triangles.size())) /
                        static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size())));
  const auto range = sample_range(mesh.positions, order.axes[1], share, number);
  const auto inside = [&](std::uint32_t v) {
    const double x = mesh.positions[v][order.axes[1]];
    return x >= range.first && x <= range.second;
  };
  constexpr std::uint8_t k_in = 1;
  constexpr std::uint8_t k_out = 2;
  std::vector<std::uint8_t> seen(mesh.positions.size(), 0);
  Part part;
  part.positions = stream.positions;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const bool in = inside(t[0]) && inside(t[1]) && inside(t[2]);
    for (const std::uint32_t v : t) seen[v] |= in ? k_in : k_out;
    if (!in) continue;
    part.mesh.triangles.push_back(t);
    part.mesh.columns.append(mesh.columns, i);
  }
  std::vector<std::uint32_t> index(mesh.positions.size(), k_no_slab);
  const auto is_edge = [&](std::uint32_t v) {
    return (seen[v] & k_out) != 0 || stream.boundary[v] != 0;
  };
  for (const bool edge : {true, false}) {
    for (std::uint32_t v = 0; v < seen.size(); ++v) {
      if ((seen[v] & k_in) == 0 || is_edge(v) != edge) continue;
      index[v] = static_cast<std::uint32_t>(part.mesh.positions.size());
      append_vertex(VertexView(mesh), v, part.mesh);
    }
    if (edge) part.boundary_vertices = static_cast<std::uint32_t>(part.mesh.positions.size());
  }
  renumber_corners(part.mesh.triangles, index);
  return part;
}

}  // namespace meshfarm
