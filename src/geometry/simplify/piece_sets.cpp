// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/piece_sets.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>

#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {

PieceSets::PieceSets(const Mesh& mesh, std::span<const std::uint8_t> flags)
    : mesh_(mesh), flags_(flags), first_(mesh.triangles.size()), sets_(give_nodes()) {
  list_edges();
  join();
  measure();
  drop_open();
}

bool PieceSets::is_complex(std::uint32_t v) const {
  return (flags_[v] & k_complex) != 0;
}

/// A triangle gets the node of one of its simple vertices, or one of its own if all are complex.
/// Returns the number of nodes.
std::size_t PieceSets::give_nodes() {
  auto nodes = static_cast<std::uint32_t>(mesh_.positions.size());
  for (std::size_t i = 0; i < first_.size(); ++i) {
    const Triangle& t = mesh_.triangles[i];
    const auto simple = std::find_if(t.begin(), t.end(), [&](auto v) { return !is_complex(v); });
    first_[i] = simple != t.end() ? *simple : nodes++;
  }
  sizes_.assign(nodes, 0);
  touches_.assign(nodes, 0);
  return nodes;
}

/// Lists the edges between complex vertices. All others have two triangles, joined by a vertex.
void PieceSets::list_edges() {
  for (std::uint32_t i = 0; i < first_.size(); ++i) {
    const Triangle& t = mesh_.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (!is_complex(a) || !is_complex(b)) continue;
      edges_.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), i});
    }
  }
  std::sort(edges_.begin(), edges_.end(), [](const Edge& x, const Edge& y) {
    return std::pair(x.ends, x.triangle) < std::pair(y.ends, y.triangle);
  });
}

template <typename Take>
void PieceSets::for_edges(const Take& take) const {
  for (std::size_t first = 0, last = 0; first < edges_.size(); first = last) {
    while (last < edges_.size() && edges_[last].ends == edges_[first].ends) ++last;
    take(std::span(edges_).subspan(first, last - first));
  }
}

void PieceSets::join() {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    for (const std::uint32_t v : mesh_.triangles[i]) {
      if (v != first_[i] && !is_complex(v)) sets_.join(first_[i], v);
    }
  }
  for_edges([&](std::span<const Edge> same) {
    if (same.size() == 2) sets_.join(first_[same[0].triangle], first_[same[1].triangle]);
  });
}

void PieceSets::measure() {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    const std::uint32_t set = of_triangle(i);
    ++sizes_[set];
    for (const std::uint32_t v : mesh_.triangles[i]) {
      if (is_complex(v)) touches_[set] = 1;
    }
  }
}

void PieceSets::drop_open() {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    for (const std::uint32_t v : mesh_.triangles[i]) {
      if ((flags_[v] & (k_fixed | k_border)) != 0) sizes_[of_triangle(i)] = 0;
    }
  }
  for_edges([&](std::span<const Edge> same) {
    for (const Edge& edge : same) {
      const std::uint32_t set = of_triangle(edge.triangle);
      const auto own = std::count_if(same.begin(), same.end(), [&](const Edge& other) {
        return of_triangle(other.triangle) == set;
      });
      if (own != 2) sizes_[set] = 0;
    }
  });
}

bool separate_small_pieces(Mesh& mesh, std::span<const std::uint8_t> flags) {
  if (std::none_of(flags.begin(), flags.end(), [](auto f) { return (f & k_complex) != 0; })) {
    return false;
  }
  PieceSets sets(mesh, flags);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;  // by set and vertex
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t set = sets.of_triangle(i);
    if (!sets.is_small(set) || !sets.touches(set)) continue;
    for (std::uint32_t& v : mesh.triangles[i]) {
      if ((flags[v] & k_complex) == 0) continue;
      const auto next = static_cast<std::uint32_t>(mesh.positions.size());
      const auto [copy, is_new] = copies.try_emplace({set, v}, next);
      if (is_new) append_vertex(VertexView(mesh), v, mesh);
      v = copy->second;
    }
  }
  return !copies.empty();
}

}  // namespace meshfarm
