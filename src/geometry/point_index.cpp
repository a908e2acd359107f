// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nanoflann.hpp>

#include <meshfarm/geometry/point_index.hpp>

namespace meshfarm {
namespace {

/// The view of the points that nanoflann requires.
struct PointCloud {
  std::vector<Vec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

/// The result of a search so far, in the form that nanoflann requires: the nearest that counts.
class LeastValue {
 public:
  LeastValue(const std::function<double(std::uint32_t)>& value, double most)
      : value_(value), least_(most) {}
  bool addPoint(double squared, std::uint32_t point) {  // NOLINT(readability-identifier-naming)
    if (squared < least_) least_ = std::min(least_, value_(point));
    return true;
  }
  double worstDist() const { return least_; }  // NOLINT(readability-identifier-naming)
  bool full() const { return true; }
  std::size_t size() const { return 1; }

 private:
  const std::function<double(std::uint32_t)>& value_;
  double least_;
};

std::array<double, 3> array_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

}  // namespace

class PointIndex::Tree {
 public:
  explicit Tree(std::vector<Vec3> points) : cloud_{std::move(points)}, index_(3, cloud_) {}
  const auto& index() const { return index_; }
  std::span<const Vec3> points() const { return cloud_.points; }

 private:
  PointCloud cloud_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>, PointCloud,
                                      3, std::uint32_t>
      index_;
};

PointIndex::PointIndex(std::vector<Vec3> points)
    : tree_(std::make_unique<Tree>(std::move(points))) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

std::span<const Vec3> PointIndex::points() const {
  return tree_->points();
}

std::size_t PointIndex::nearest(Vec3 from, std::span<std::uint32_t> found) const {
  std::vector<double> squared(found.size());
  return tree_->index().knnSearch(array_of(from).data(), found.size(), found.data(),
                                  squared.data());
}

double PointIndex::least(Vec3 from, double most,
                         const std::function<double(std::uint32_t)>& value) const {
  LeastValue least(value, most);
  tree_->index().findNeighbors(least, array_of(from).data(), nanoflann::SearchParams());
  return least.worstDist();
}

}  // namespace meshfarm
