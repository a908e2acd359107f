// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Charts: connected regions of triangles whose normals lie within a cone, so that projection along
// its axis flips no triangle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/texture/triangle_links.hpp"

namespace meshfarm {

/// Input for making charts: links, normal, area and centre of each triangle.
struct ChartSurface {
  const Mesh& mesh;
  std::vector<Vec3> normals;  // of length 1; 0 without an area
  std::vector<double> areas;
  std::vector<Vec3> centers;
  std::vector<TriangleLinks> links;

  std::size_t triangles() const { return areas.size(); }
};

ChartSurface chart_surface(const Mesh& mesh, unsigned threads);

/// The triangles of each chart, in order; charts are numbered from 0.
class ChartLists {
 public:
  /// `chart_of` may hold k_no_chart.
  ChartLists(std::span<const std::uint32_t> chart_of, std::uint32_t charts);
  std::uint32_t charts() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  std::span<const std::uint32_t> of(std::uint32_t chart) const {
    return {triangles_.data() + first_[chart], first_[chart + 1] - first_[chart]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> triangles_;
};

struct Charts {
  std::vector<std::uint32_t> chart_of;  // of each triangle, or k_no_chart
  std::uint32_t count = 0;
};

/// An axis for a chart with these triangles: the area-weighted mean of their normals, moved if
/// necessary so that each normal's cosine with it is at least `least`. 0 if there is no such axis.
Vec3 chart_axis(const ChartSurface& surface, std::span<const std::uint32_t> triangles,
                double least);

/// The final lower limit for the cosine of a chart's normals with its axis, as passed to
/// chart_axis().
inline constexpr double k_least_cosine = 0.17;

/// Divides the surface into charts. Charts with an area below `tiny_area` are joined with others
/// where possible.
Charts make_charts(const ChartSurface& surface, double tiny_area);

/// One step of make_charts(): joins charts with neighbours.
void join_charts(const ChartSurface& surface, double tiny_area, Charts& charts);

}  // namespace meshfarm
