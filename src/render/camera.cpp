// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include <meshfarm/render/camera.hpp>

namespace meshfarm {
namespace {

constexpr double k_half_angle = 15 * std::numbers::pi / 180;  // half field of view, shorter side
constexpr double k_filled = 0.94;                             // of the frame; the rest is margin

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// The front viewer's direction.
Vec3 front_of(Vec3 up) {
  return up.z != 0 ? Vec3{0, -1, 0} : Vec3{0, 0, 1};
}

double one_if_none(double length) {
  return length > 0 ? length : 1;
}

}  // namespace

ViewAxes::ViewAxes(const View& view) {
  const Vec3 front = front_of(view.up);
  const Vec3 side = cross(view.up, front);
  const double a = radians(view.azimuth);
  const double e = radians(view.elevation);
  right = side * std::cos(a) - front * std::sin(a);
  toward = (side * std::sin(a) + front * std::cos(a)) * std::cos(e) + view.up * std::sin(e);
  up = cross(toward, right);
}

Framing::Framing(const View& view, const Frame& frame)
    : axes_(view), projection_(view.projection), frame_(frame) {
  reach_.fill(-HUGE_VAL);
  if (projection_ == Projection::orthographic) return;
  const double slope = k_filled * std::tan(k_half_angle) / std::min(frame.width, frame.height);
  slope_x_ = slope * frame.width;
  slope_y_ = slope * frame.height;
}

void Framing::add(std::span<const Vec3> vertices) {
  std::array<double, 6> reach = reach_;
  const auto count = [](double value, double& greatest) {
    greatest = value > greatest ? value : greatest;  // false for NaN
  };
  for (const Vec3& vertex : vertices) {
    const Vec3 p = axes_.seen(vertex);
    count(p.z, reach[0]);
    count(-p.z, reach[1]);
    count(p.x + slope_x_ * p.z, reach[2]);
    count(-p.x + slope_x_ * p.z, reach[3]);
    count(p.y + slope_y_ * p.z, reach[4]);
    count(-p.y + slope_y_ * p.z, reach[5]);
  }
  reach_ = reach;
}

Camera Framing::camera() const {
  Camera camera = projection_ == Projection::perspective ? perspective() : orthographic();
  camera.projection_ = projection_;
  camera.centre_x_ = frame_.left + frame_.width / 2 - 0.5;  // sample centres are at integers
  camera.centre_y_ = frame_.top + frame_.height / 2 - 0.5;
  return camera;
}

Camera Framing::perspective() const {
  Camera camera(axes_);
  const double depth = reach_[0] + reach_[1];
  // The sides of the view meet at or in front of the eye. A minimum distance is kept.
  const double by_width = (reach_[2] + reach_[3]) / (2 * slope_x_);
  const double by_height = (reach_[4] + reach_[5]) / (2 * slope_y_);
  const double least = reach_[0] + 0.05 * depth;
  double z = std::max({by_width, by_height, least});
  if (!(z > reach_[0])) z = reach_[0] + 1;  // a single point
  camera.eye_ = {(reach_[2] - reach_[3]) / 2, (reach_[4] - reach_[5]) / 2, z};
  camera.scale_ = k_filled * frame_.width / 2 / slope_x_;
  camera.near_ = 1 / (z - reach_[0]);
  camera.far_ = 1 / (z + reach_[1]);
  if (!(camera.near_ > camera.far_)) camera.near_ = 2 * camera.far_;
  return camera;
}

Camera Framing::orthographic() const {
  Camera camera(axes_);
  const double width = reach_[2] + reach_[3];
  const double height = reach_[4] + reach_[5];
  const double across = std::max(width / frame_.width, height / frame_.height);
  camera.scale_ = k_filled / one_if_none(across);
  camera.eye_ = {(reach_[2] - reach_[3]) / 2, (reach_[4] - reach_[5]) / 2, -reach_[1]};
  camera.far_ = 0;
  camera.near_ = one_if_none(reach_[0] + reach_[1]);
  return camera;
}

}  // namespace meshfarm
