// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <meshfarm/geometry/column_floor.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/texture/seam_graph.hpp"
#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

/// Vertices with more triangles are ignored.
constexpr std::size_t k_most_triangles = 1024;

constexpr std::uint32_t k_no_column = SeamGraph::k_none;

/// An edge of a line or a border, and the triangles there.
struct LineEdge {
  std::array<std::uint32_t, 2> ends;
  std::array<std::uint32_t, 2> triangles;  // the second may be k_no_column
};

/// Calls take(i, k) for the edges from a vertex: i is the corner that ends at the edge, k the one
/// that begins there; either is the fan's size if there is none.
template <typename Take>
void for_edges(const CornerFan& fan, const Take& take) {
  const std::size_t size = fan.corners.size();
  for (std::size_t i = 0; i < size; ++i) {
    std::size_t beginning = size;
    bool is_ended = false;
    for (std::size_t k = 0; k < size; ++k) {
      if (fan.corners[k].next == fan.corners[i].prev) beginning = k;
      if (fan.corners[k].prev == fan.corners[i].next) is_ended = true;
    }
    take(i, beginning);
    if (!is_ended) take(size, i);
  }
}

class GraphBuilder {
 public:
  GraphBuilder(const Mesh& mesh, const TriangleColumnsView& columns, std::size_t locked)
      : locked_(locked),
        positions_(mesh.positions),
        chart_of_(mesh.triangles.size()),
        inner_edges_(mesh.triangles.size(), 0),
        corner_(mesh.positions.size(), k_no_column),
        is_on_line_(mesh.positions.size(), 0) {
    adjacency_.build(mesh.triangles, mesh.positions.size(), columns);
  }

  SeamGraph build() {
    const auto vertices = static_cast<std::uint32_t>(corner_.size());
    for (std::uint32_t v = 0; v < vertices; ++v) look_at(v);
    number_charts();
    for (std::uint32_t i = 0; i < inner_edges_.size(); ++i) {
      SeamGraph::Chart& chart = graph_.charts[chart_at(i)];
      // Of vertices - edges + triangles: one edge per side, but inner edges are shared.
      chart.euler += inner_edges_[i] - 2;
      ++chart.triangles;
    }
    for (std::uint32_t v = 0; v < vertices; ++v) count_sides(v);
    trace_lines();
    return std::move(graph_);
  }

 private:
  CornerFan fan_at(std::uint32_t vertex) const {
    return adjacency_.count(vertex) > k_most_triangles ? CornerFan{} : adjacency_.fan_at(vertex);
  }

  void look_at(std::uint32_t vertex) {
    const CornerFan fan = fan_at(vertex);
    const std::size_t size = fan.corners.size();
    std::size_t lines = 0;
    std::size_t borders = 0;
    for_edges(fan, [&](std::size_t i, std::size_t k) {
      const std::uint32_t end = i < size ? fan.corners[i].prev : fan.corners[k].next;
      const bool is_border = i == size || k == size;
      const std::uint32_t triangle = fan.ids[i < size ? i : k] / 3;
      if (is_border || fan.differ(i, k)) {
        ++(is_border ? borders : lines);
        const std::uint32_t other = is_border ? k_no_column : fan.ids[k] / 3;
        if (end > vertex) edges_.push_back({{vertex, end}, {triangle, other}});
      } else if (end > vertex) {
        chart_of_.join(triangle, fan.ids[k] / 3);
        ++inner_edges_[triangle];
      }
    });
    is_on_line_[vertex] = lines + borders > 0 ? 1 : 0;
    if (vertex < locked_ || lines == 0 || (lines == 2 && borders == 0)) return;
    corner_[vertex] = static_cast<std::uint32_t>(graph_.corners.size());
    SeamGraph::Corner& corner = graph_.corners.emplace_back();
    corner.position = positions_[vertex];
    corner.is_on_border = borders > 0;
  }

  void number_charts() {
    chart_numbers_.assign(inner_edges_.size(), k_no_column);
    std::uint32_t charts = 0;
    for (std::uint32_t i = 0; i < chart_numbers_.size(); ++i) {
      if (chart_of_.find(i) == i) chart_numbers_[i] = charts++;
    }
    graph_.charts.resize(charts);
  }

  std::uint32_t chart_at(std::uint32_t triangle) {
    return chart_numbers_[chart_of_.find(triangle)];
  }

  /// Counts a vertex for each of its charts: once inside, on the rim as often as the rim visits it.
  void count_sides(std::uint32_t vertex) {
    const CornerFan fan = fan_at(vertex);
    const std::size_t size = fan.corners.size();
    UnionFind sides(size);
    for_edges(fan, [&](std::size_t i, std::size_t k) {
      if (i == size || k == size || fan.differ(i, k)) return;
      sides.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
    });
    for (std::uint32_t i = 0; i < size; ++i) {
      if (sides.find(i) != i) continue;
      const std::uint32_t number = chart_at(fan.ids[i] / 3);
      SeamGraph::Chart& chart = graph_.charts[number];
      ++chart.euler;
      chart.is_part = chart.is_part || vertex < locked_;
      if (corner_[vertex] == k_no_column) continue;
      ++chart.corners;
      graph_.corners[corner_[vertex]].charts.push_back(number);
    }
  }

  void trace_lines() {
    const auto is_inner = [&](std::uint32_t v) { return corner_[v] == k_no_column; };
    UnionFind sets(corner_.size());
    for (const LineEdge& e : edges_) {
      if (is_inner(e.ends[0]) && is_inner(e.ends[1])) sets.join(e.ends[0], e.ends[1]);
    }
    std::vector<std::uint32_t> line_of(corner_.size(), k_no_column);
    for (const LineEdge& e : edges_) {
      const std::uint32_t inner = is_inner(e.ends[0]) ? e.ends[0] : e.ends[1];
      auto number = static_cast<std::uint32_t>(graph_.lines.size());
      if (is_inner(inner)) {
        std::uint32_t& known = line_of[sets.find(inner)];
        if (known == k_no_column) known = number;
        number = known;
      }
      if (number == graph_.lines.size()) add_line(e);
      graph_.lines[number].length += length(positions_[e.ends[0]] - positions_[e.ends[1]]);
      for (const std::uint32_t end : e.ends) {
        if (is_inner(end)) continue;
        graph_.lines[number].add_corner(corner_[end]);
        graph_.corners[corner_[end]].lines.push_back(number);
      }
    }
    for (std::uint32_t v = 0; v < corner_.size(); ++v) {
      if (is_on_line_[v] == 0 || !is_inner(v)) continue;
      const std::uint32_t number = line_of[sets.find(v)];
      if (number != k_no_column) ++graph_.lines[number].inner;
    }
    for (SeamGraph::Line& line : graph_.lines) {
      std::sort(line.corners.begin(), line.corners.end());
    }
  }

  void add_line(const LineEdge& edge) {
    const auto number = static_cast<std::uint32_t>(graph_.lines.size());
    SeamGraph::Line& line = graph_.lines.emplace_back();
    for (std::size_t side = 0; side < 2; ++side) {
      if (edge.triangles[side] == k_no_column) continue;
      line.charts[side] = chart_at(edge.triangles[side]);
      graph_.charts[line.charts[side]].lines.push_back(number);
    }
  }

  std::size_t locked_;
  std::span<const Vec3> positions_;
  Adjacency adjacency_;
  UnionFind chart_of_;                        // sets of triangles
  std::vector<std::uint32_t> chart_numbers_;  // of the sets, at their representative triangles
  std::vector<std::uint8_t> inner_edges_;     // those assigned to each triangle
  std::vector<std::uint32_t> corner_;         // the corner number of each vertex
  std::vector<std::uint8_t> is_on_line_;
  std::vector<LineEdge> edges_;
  SeamGraph graph_;
};

}  // namespace

ColumnFloor find_column_floor(const Mesh& mesh, const ColumnSet& columns, std::size_t locked) {
  TriangleColumnsView kept = mesh.columns;
  if (!columns.labels) kept.labels = {};
  if (!columns.uvs) kept.uvs = {};
  if (kept.empty() || mesh.triangles.empty()) return {};
  SeamGraph graph = GraphBuilder(mesh, kept, locked).build();
  const std::uint64_t corners = graph.corners.size();
  return {corners, floor_of(std::move(graph))};
}

}  // namespace meshfarm
