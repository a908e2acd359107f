// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/render/camera.hpp>

using namespace meshfarm;

namespace {

constexpr Frame k_frame{.left = 0, .top = 0, .width = 400, .height = 300};

/// The corners of a box from -1 to 1, but twice as high.
std::vector<Vec3> box() {
  std::vector<Vec3> corners;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-2.0, 2.0}) {
      for (const double z : {-1.0, 1.0}) corners.push_back({x, y, z});
    }
  }
  return corners;
}

Camera camera_for(const View& view) {
  Framing framing(view, k_frame);
  framing.add(box());
  return framing.camera();
}

double apart(Vec3 a, Vec3 b) {
  return length(a - b);
}

}  // namespace

TEST_CASE("views look from where their names say, with the axis up that was asked for") {
  const auto toward = [](double azimuth, double elevation, Vec3 up) {
    return ViewAxes({.azimuth = azimuth, .elevation = elevation, .up = up}).toward;
  };
  CHECK(apart(toward(0, 0, {0, 1, 0}), {0, 0, 1}) < 1e-9);
  CHECK(apart(toward(90, 0, {0, 1, 0}), {1, 0, 0}) < 1e-9);
  CHECK(apart(toward(0, 90, {0, 1, 0}), {0, 1, 0}) < 1e-9);
  CHECK(apart(toward(0, 0, {0, 0, 1}), {0, -1, 0}) < 1e-9);
  CHECK(apart(toward(90, 0, {0, 0, 1}), {1, 0, 0}) < 1e-9);
  CHECK(apart(toward(0, -90, {0, 0, 1}), {0, 0, -1}) < 1e-9);
  for (const Vec3 up : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1}, Vec3{-1, 0, 0}}) {
    const ViewAxes axes({.azimuth = 20, .elevation = 0, .up = up});
    CHECK(apart(axes.up, up) < 1e-9);
    CHECK(apart(cross(axes.right, axes.up), axes.toward) < 1e-9);
  }
}

TEST_CASE("the camera is as near as the frame allows, and sees all") {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (const double azimuth : {0.0, 30.0, 200.0}) {
      CAPTURE(azimuth);
      const Camera camera =
          camera_for({.projection = projection, .azimuth = azimuth, .elevation = 25});
      double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
      float near = 0, far = 1;
      for (const Vec3& corner : box()) {
        const ScreenPoint p = camera.project(corner);
        left = std::min<double>(left, p.x);
        right = std::max<double>(right, p.x);
        top = std::min<double>(top, p.y);
        bottom = std::max<double>(bottom, p.y);
        near = std::max(near, p.depth);
        far = std::min(far, p.depth);
      }
      CHECK(left > 0);
      CHECK(right < k_frame.width);
      CHECK(top > 0);
      CHECK(bottom < k_frame.height);
      CHECK(bottom - top > 0.9 * k_frame.height);  // higher than wide
      CHECK(bottom - top < 0.97 * k_frame.height);
      CHECK(near == doctest::Approx(1));
      CHECK(far == doctest::Approx(0));
    }
  }
}

TEST_CASE("right is right, up is up, and what is nearer is so on the picture") {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const Camera camera = camera_for({.projection = projection, .azimuth = 0, .elevation = 0});
    const ScreenPoint middle = camera.project({0, 0, 0});
    CHECK(camera.project({1, 0, 0}).x > middle.x + 10);
    CHECK(camera.project({0, 1, 0}).y < middle.y - 10);
    CHECK(camera.project({0, 0, 1}).depth > middle.depth + 0.1F);
    const double near = camera.project({1, 0, 1}).x, far = camera.project({1, 0, -1}).x;
    CHECK((projection == Projection::perspective ? near > far + 5 : near == far));
  }
}

TEST_CASE("points come back from the picture, at the mesh's scale") {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const Camera camera = camera_for({.projection = projection});
    const Vec3 a{0.3, -0.7, 0.1}, b{-0.5, 1.2, 0.9};
    const Vec3 seen = camera.unproject(camera.project(b)) - camera.unproject(camera.project(a));
    CHECK(apart(camera.axes().in_world(seen), b - a) < 1e-5);
  }
}

TEST_CASE("a point, a line and a plane seen from its side have a camera") {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (const Vec3 far : {Vec3{5, 5, 5}, Vec3{5, 5, 9}, Vec3{5, 8, 5}}) {
      Framing framing({.projection = projection, .azimuth = 0, .elevation = 0}, k_frame);
      CHECK(framing.empty());
      framing.add(std::vector<Vec3>{{5, 5, 5}, k_no_position, far});
      CHECK_FALSE(framing.empty());
      const ScreenPoint p = framing.camera().project(far);
      CHECK((p.x >= 0 && p.x <= k_frame.width));
      CHECK((p.y >= 0 && p.y <= k_frame.height));
      CHECK((p.depth >= 0 && p.depth <= 1));
    }
  }
}
