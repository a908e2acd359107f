// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <nanoflann.hpp>

namespace meshfarm {
namespace {

/// The view of the vertices that nanoflann asks for.
struct VertexCloud {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> vertices;
  std::size_t kdtree_get_point_count() const { return positions.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return positions[i][static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

VertexCloud vertices_of(const ShrinkingMesh& mesh) {
  VertexCloud cloud;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.target[v] != v || mesh.adjacency->count(v) == 0) continue;
    cloud.positions.push_back(mesh.positions[v]);
    cloud.vertices.push_back(v);
  }
  return cloud;
}

/// What a search has found so far, as nanoflann asks for it: the nearest that counts.
template <class Counts>
class Nearest {
 public:
  explicit Nearest(const Counts& counts) : counts_(counts) {}
  bool addPoint(double squared, std::uint32_t point) {
    if (squared < squared_ && counts_(point)) squared_ = squared;
    return true;
  }
  double worstDist() const { return squared_; }
  bool full() const { return true; }
  std::size_t size() const { return 1; }

 private:
  const Counts& counts_;
  double squared_ = HUGE_VAL;
};

}  // namespace

class Surroundings::Tree {
 public:
  explicit Tree(const ShrinkingMesh& mesh) : cloud_(vertices_of(mesh)), index_(3, cloud_) {}

  double squared_distance(const ShrinkingMesh& mesh, Vec3 from,
                          std::span<const std::uint32_t> without) const {
    const auto counts = [&](std::uint32_t point) {
      std::uint32_t v = cloud_.vertices[point];
      while (mesh.target[v] != v) v = mesh.target[v];
      return mesh.adjacency->count(v) > 0 && !std::binary_search(without.begin(), without.end(), v);
    };
    Nearest<decltype(counts)> nearest(counts);
    const double at[3] = {from.x, from.y, from.z};
    index_.findNeighbors(nearest, at, nanoflann::SearchParams());
    return nearest.worstDist();
  }

 private:
  VertexCloud cloud_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, VertexCloud>,
                                      VertexCloud, 3, std::uint32_t>
      index_;
};

Surroundings::Surroundings() = default;
Surroundings::~Surroundings() = default;
Surroundings::Surroundings(Surroundings&&) noexcept = default;
Surroundings& Surroundings::operator=(Surroundings&&) noexcept = default;

double Surroundings::squared_distance(const ShrinkingMesh& mesh, Vec3 from,
                                      std::span<const std::uint32_t> without) {
  if (!tree_) tree_ = std::make_unique<Tree>(mesh);
  return tree_->squared_distance(mesh, from, without);
}

}  // namespace meshfarm
