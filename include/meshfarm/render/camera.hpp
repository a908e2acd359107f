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

/// From where a mesh is looked at. Azimuth goes round the axis that is up, counter-clockwise seen
/// from above, from the front (0) to the right (90). In degrees.
struct View {
  Projection projection = Projection::perspective;
  double azimuth = 45;
  double elevation = 35.264;  // of an isometric view
  Vec3 up{0, 1, 0};           // an axis, or its opposite
};

/// The directions of a view, each of length 1 and at right angles to the others.
struct ViewAxes {
  Vec3 right;
  Vec3 up;
  Vec3 toward;  // the viewer

  explicit ViewAxes(const View& view);
  /// A direction of the world as the viewer sees it: x to the right, y up, z toward the viewer.
  Vec3 seen(Vec3 p) const { return {dot(right, p), dot(up, p), dot(toward, p)}; }
  /// The opposite of seen().
  Vec3 in_world(Vec3 p) const { return right * p.x + up * p.y + toward * p.z; }
};

/// The rectangle that the mesh is to fill, in samples from the picture's upper left corner.
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

/// Projects the world onto the picture. Straight lines stay straight, in depth, too.
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
  /// The point as the viewer sees it: x to the right, y up, z toward the viewer.
  Vec3 unproject(const ScreenPoint& p) const {
    return unproject(across(static_cast<double>(p.x)), along(static_cast<double>(p.y)), p.depth);
  }
  /// The same where across() of its column and along() of its row are known.
  Vec3 unproject(double across_x, double along_y, float depth) const {
    const double place = far_ + static_cast<double>(depth) * (near_ - far_);
    const bool is_flat = projection_ == Projection::orthographic;
    const double distance = is_flat ? 1 : 1 / place;
    return {across_x * distance, along_y * distance, is_flat ? place : -distance};
  }
  /// Where a column or a row of samples lies, at distance 1.
  double across(double x) const { return (x - centre_x_) / scale_; }
  double along(double y) const { return (centre_y_ - y) / scale_; }
  /// One by the distance, without perspective 1. Values can be blended linearly over the picture if
  /// they are multiplied by it.
  double nearness(double depth) const {
    return projection_ == Projection::orthographic ? 1 : far_ + depth * (near_ - far_);
  }
  const ViewAxes& axes() const { return axes_; }

  /// What project() does, by rows of a matrix: a point p is at
  /// x = middle_x + (dot(x, p) + x0) / d, y = middle_y + (dot(y, p) + y0) / d, where
  /// d = dot(z, p) + z0 is above 0 before the viewer.
  struct Rows {
    Vec3 x, y, z;
    double x0 = 0, y0 = 0, z0 = 1;
    double middle_x = 0, middle_y = 0;
    double scale = 1;  // the length of x, and of y
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
  Vec3 eye_;          // as seen; without projection its z is that of depth 0
  double scale_ = 1;  // samples a unit, with perspective at distance 1
  double centre_x_ = 0;
  double centre_y_ = 0;
  double far_ = 0;   // depth 0: one by the distance, without perspective the z
  double near_ = 1;  // depth 1
};

/// Finds the camera that is as near as all vertices allow. One scan of these is enough: how far
/// they reach toward each side of the picture is all that counts.
class Framing {
 public:
  Framing(const View& view, const Frame& frame);
  /// Vertices without a position count for nothing.
  void add(std::span<const Vec3> vertices);
  bool empty() const { return !(reach_[0] >= -reach_[1]); }
  Camera camera() const;

 private:
  Camera perspective() const;
  Camera orthographic() const;

  ViewAxes axes_;
  Projection projection_;
  Frame frame_;
  double slope_x_ = 0;  // of the sides of what is seen; 0 without perspective
  double slope_y_ = 0;
  // Greatest z, -z, and distance beyond the right, left, upper and lower side.
  std::array<double, 6> reach_;
};

}  // namespace meshfarm
