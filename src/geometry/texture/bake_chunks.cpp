// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/bake_chunks.hpp>
#include <meshfarm/geometry/curve_order.hpp>
#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/geometry/vertex_normals.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_chunk_cell = 32;  // texels per side

std::uint64_t rounded_up(double x) {
  return static_cast<std::uint64_t>(std::ceil(x));
}

}  // namespace

BakeChunks::BakeChunks(const Mesh& mesh, std::span<const CornerUvs> uvs,
                       const BakeChunkOptions& options)
    : mesh_(mesh),
      uvs_(uvs),
      options_(options),
      normals_(vertex_normals(mesh)),
      cells_a_side_(std::max(1U, (options.texture_size + k_chunk_cell - 1) / k_chunk_cell)) {
  if (mesh.triangles.empty()) return;
  divide();
  sort_into_cells();
}

/// Divides into chunks of about equal work: a triangle costs as much as a few texels in addition to
/// its own.
void BakeChunks::divide() {
  constexpr double k_texels_of_triangle = 4;
  order_ = along_a_curve(mesh_);
  const double side = options_.texture_size;
  std::vector<double> covered(order_.size());
  double all = 0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    covered[i] = uv_area(uvs_[order_[i]]) * side * side;
    all += covered[i];
  }
  const double triangles = static_cast<double>(order_.size());
  const std::uint64_t wanted =
      std::max(rounded_up(all / static_cast<double>(options_.texels)),
               rounded_up(triangles / static_cast<double>(options_.triangles)));
  const std::uint64_t most = std::min<std::uint64_t>(options_.most_chunks, order_.size());
  const auto chunks = static_cast<double>(std::clamp<std::uint64_t>(wanted, 1, most));
  const double a_chunk = (all + k_texels_of_triangle * triangles) / chunks;
  double done = 0;
  double texels = 0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    texels += covered[i];
    done += covered[i] + k_texels_of_triangle;
    const bool is_last = i + 1 == order_.size();
    if (!is_last && done < a_chunk * static_cast<double>(ends_.size() + 1)) continue;
    const auto begin =
        order_.begin() + static_cast<std::ptrdiff_t>(ends_.empty() ? 0 : ends_.back());
    std::sort(begin, order_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    ends_.push_back(i + 1);
    texels_.push_back(static_cast<std::uint64_t>(texels));
    texels = 0;
  }
}

BakeChunks::Cells BakeChunks::cells_of(std::uint32_t triangle, double margin) const {
  const double side = options_.texture_size;
  const auto cell = [&](double x) {
    return static_cast<std::uint32_t>(std::clamp(x / k_chunk_cell, 0.0, cells_a_side_ - 1.0));
  };
  const CornerUvs& uvs = uvs_[triangle];
  const auto [u0, u1] = std::minmax({uvs[0][0], uvs[1][0], uvs[2][0]});
  const auto [v0, v1] = std::minmax({uvs[0][1], uvs[1][1], uvs[2][1]});
  return {
      cell(static_cast<double>(u0) * side - margin), cell(static_cast<double>(v0) * side - margin),
      cell(static_cast<double>(u1) * side + margin), cell(static_cast<double>(v1) * side + margin)};
}

void BakeChunks::sort_into_cells() {
  const auto for_cells = [this](const auto& take) {
    for (std::uint32_t t = 0; t < uvs_.size(); ++t) {
      const Cells cells = cells_of(t, 0);
      for (std::uint32_t y = cells.y0; y <= cells.y1; ++y) {
        for (std::uint32_t x = cells.x0; x <= cells.x1; ++x) {
          take(std::size_t{y} * cells_a_side_ + x, t);
        }
      }
    }
  };
  cell_begins_.assign(std::size_t{cells_a_side_} * cells_a_side_ + 2, 0);
  for_cells([this](std::size_t cell, std::uint32_t) { ++cell_begins_[cell + 2]; });
  for (std::size_t i = 1; i < cell_begins_.size(); ++i) cell_begins_[i] += cell_begins_[i - 1];
  in_cells_.resize(cell_begins_.back());
  for_cells([this](std::size_t cell, std::uint32_t t) { in_cells_[cell_begins_[cell + 1]++] = t; });
}

std::span<const std::uint32_t> BakeChunks::own(std::size_t chunk) const {
  const std::size_t begin = chunk == 0 ? 0 : ends_[chunk - 1];
  return std::span(order_).subspan(begin, ends_[chunk] - begin);
}

/// The chunk's own triangles, and all that its texels may be nearer to, or may have passed on their
/// way to an owner: those within twice the margin. Ascending.
std::vector<std::uint32_t> BakeChunks::with_neighbours(std::size_t chunk) const {
  const double margin = 2 * (options_.margin_texels + 1.0);
  std::vector<std::size_t> cells;
  for (const std::uint32_t t : own(chunk)) {
    const Cells near = cells_of(t, margin);
    for (std::uint32_t y = near.y0; y <= near.y1; ++y) {
      for (std::uint32_t x = near.x0; x <= near.x1; ++x) {
        cells.push_back(std::size_t{y} * cells_a_side_ + x);
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::vector<std::uint32_t> found(own(chunk).begin(), own(chunk).end());
  for (const std::size_t cell : cells) {
    found.insert(found.end(), in_cells_.begin() + static_cast<std::ptrdiff_t>(cell_begins_[cell]),
                 in_cells_.begin() + static_cast<std::ptrdiff_t>(cell_begins_[cell + 1]));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

BakeSurface BakeChunks::surface(std::size_t chunk) const {
  const std::span<const std::uint32_t> own_triangles = own(chunk);
  const std::vector<std::uint32_t> triangles = with_neighbours(chunk);
  std::vector<std::uint32_t> used;
  for (const std::uint32_t t : triangles) {
    used.insert(used.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  BakeSurface made;
  for (const std::uint32_t v : used) {
    made.positions.push_back(mesh_.positions[v]);
    made.normals.push_back(normals_[v]);
  }
  for (const std::uint32_t t : triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(used.begin(), used.end(), mesh_.triangles[t][k]);
      corners[k] = static_cast<std::uint32_t>(at - used.begin());
    }
    made.triangles.push_back(corners);
    made.uvs.push_back(uvs_[t]);
    made.is_own.push_back(std::binary_search(own_triangles.begin(), own_triangles.end(), t) ? 1
                                                                                            : 0);
  }
  return made;
}

}  // namespace meshfarm
