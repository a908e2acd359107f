// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

enum class Projection : std::uint8_t { perspective, orthographic };

/// The direction from which a mesh is viewed, in degrees. Azimuth turns around the up axis,
/// counter-clockwise seen from above, from the front (0) to the right (90).
struct View {
  Projection projection = Projection::perspective;
  double azimuth = 45;
  double elevation = 35.264;  // isometric
  Vec3 up{0, 1, 0};           // an axis, or its opposite
};

/// The directions of a view, orthonormal.
struct ViewAxes {
  Vec3 right;
  Vec3 up;
  Vec3 toward;  // toward the viewer

  explicit ViewAxes(const View& view);
  /// World to view coordinates: x to the right, y up, z toward the viewer.
  Vec3 seen(Vec3 p) const { return {dot(right, p), dot(up, p), dot(toward, p)}; }
  /// Inverse of seen().
  Vec3 in_world(Vec3 p) const { return right * p.x + up * p.y + toward * p.z; }
};

/// The rectangle that the mesh should fill, in samples from the picture's upper left corner.
struct Frame {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
};

/// A point on the picture, in samples. Depth is 0 for the farthest vertex and 1 for the nearest.
struct ScreenPoint {
  float x = 0;
  float y = 0;
  float depth = 0;
};

/// Projects the world onto the picture. Straight lines stay straight, also in depth.
class Camera {
 public:
  ScreenPoint project(Vec3 world) const {
    const Vec3 p = axes_.seen(world) - eye_;
    const bool is_flat = projection_ == Projection::orthographic;
    const double by_distance = is_flat ? 1 : -1 / p.z;
    const double depth = is_flat ? p.z : by_distance - far_;
    return {static_cast<float>(centre_x_ + scale_ * p.x * by_distance),
            static_cast<float>(centre_y_ - scale_ * p.y * by_distance),
            static_cast<float>(depth / (near_ - far_))};
  }
  /// The point in view coordinates: x to the right, y up, z toward the viewer.
  Vec3 unproject(const ScreenPoint& p) const {
    return unproject(across(static_cast<double>(p.x)), along(static_cast<double>(p.y)), p.depth);
  }
  /// The same if across() of its column and along() of its row are already known.
  Vec3 unproject(double across_x, double along_y, float depth) const {
    const double place = far_ + static_cast<double>(depth) * (near_ - far_);
    const bool is_flat = projection_ == Projection::orthographic;
    const double distance = is_flat ? 1 : 1 / place;
    return {across_x * distance, along_y * distance, is_flat ? place : -distance};
  }
  /// Position of a column or a row of samples at distance 1.
  double across(double x) const { return (x - centre_x_) / scale_; }
  double along(double y) const { return (centre_y_ - y) / scale_; }
  /// 1 / distance; 1 without perspective. Values multiplied by it can be interpolated linearly on
  /// the picture.
  double nearness(double depth) const {
    return projection_ == Projection::orthographic ? 1 : far_ + depth * (near_ - far_);
  }
  const ViewAxes& axes() const { return axes_; }

  /// project() as rows of a matrix: a point p projects to x = middle_x + (dot(x, p) + x0) / d, y =
  /// middle_y + (dot(y, p) + y0) / d, where d = dot(z, p) + z0 is positive in front of the viewer.
  struct Rows {
    Vec3 x, y, z;
    double x0 = 0, y0 = 0, z0 = 1;
    double middle_x = 0, middle_y = 0;
    double scale = 1;  // length of x and of y
  };
  Rows rows() const {
    Rows rows{axes_.right * scale_,
              axes_.up * -scale_,
              {},
              -scale_ * eye_.x,
              scale_ * eye_.y,
              1,
              centre_x_,
              centre_y_,
              scale_};
    if (projection_ == Projection::perspective) {
      rows.z = axes_.toward * -1;
      rows.z0 = eye_.z;
    }
    return rows;
  }

 private:
  friend class Framing;
  explicit Camera(const ViewAxes& axes) : axes_(axes) {}

  ViewAxes axes_;
  Projection projection_ = Projection::perspective;
  Vec3 eye_;          // in view coordinates; without perspective its z is that of depth 0
  double scale_ = 1;  // samples per unit; with perspective at distance 1
  double centre_x_ = 0;
  double centre_y_ = 0;
  double far_ = 0;   // at depth 0: 1 / distance, without perspective z
  double near_ = 1;  // at depth 1
};

/// Finds the closest camera that sees all vertices. One scan of the vertices is enough: only their
/// extent toward each side of the picture matters.
class Framing {
 public:
  Framing(const View& view, const Frame& frame);
  /// Vertices without a position are ignored.
  void add(std::span<const Vec3> vertices);
  bool empty() const { return !(reach_[0] >= -reach_[1]); }
  Camera camera() const;

 private:
  Camera perspective() const;
  Camera orthographic() const;

  ViewAxes axes_;
  Projection projection_;
  Frame frame_;
  double slope_x_ = 0;  // of the view's sides; 0 without perspective
  double slope_y_ = 0;
  // Maximum z, -z, and distance beyond the right, left, upper and lower side.
  std::array<double, 6> reach_;
};

}  // namespace meshfarm
