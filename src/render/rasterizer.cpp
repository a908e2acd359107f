// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/rasterizer.hpp"

#include <algorithm>
#include <cmath>

namespace meshfarm {
namespace {

const Light k_wire_colour = light_of({28, 34, 46});
const Light k_back_tint = {0.93F, 0.80F, 0.72F};

/// Smallest integer >= x, and largest integer <= x; for x >= -1.
int first_not_below(float x) {
  const int whole = static_cast<int>(x);
  return whole + (x > static_cast<float>(whole) ? 1 : 0);
}
int last_not_above(float x) {
  return x < 0 ? -1 : static_cast<int>(x);
}

/// Twice the signed area of the triangle a, b, (x, y). Exact in doubles, since a picture's
/// coordinates are floats: the triangles on both sides of an edge agree.
double side_of(const ScreenPoint& a, const ScreenPoint& b, double x, double y) {
  const double ax = static_cast<double>(a.x);
  const double ay = static_cast<double>(a.y);
  return (static_cast<double>(b.x) - ax) * (y - ay) - (static_cast<double>(b.y) - ay) * (x - ax);
}

double distance(const ScreenPoint& a, const ScreenPoint& b) {
  const double x = static_cast<double>(b.x) - static_cast<double>(a.x);
  const double y = static_cast<double>(b.y) - static_cast<double>(a.y);
  return std::sqrt(x * x + y * y);
}

Light blended(const std::array<Light, 3>& lights, const std::array<double, 3>& shares) {
  Light sum;
  for (std::size_t i = 0; i < 3; ++i) sum = sum + lights[i] * static_cast<float>(shares[i]);
  return sum;
}

}  // namespace

/// A triangle whose samples are being drawn.
struct Rasterizer::Covered {
  const std::array<ScreenPoint, 3>& corners;
  const CornerColours& colours;
  Facing facing;
  Light all;                         // its lit colour, if it has a single one
  Srgb flat{};                       // the same as drawn, if nothing changes it
  std::array<double, 3> nearness{};  // of the corners
  std::array<double, 3> heights{};   // above the sides opposite the corners, in samples
};

Rasterizer::Rasterizer(const Camera& camera, Canvas& canvas, Wire wire)
    : camera_(camera),
      canvas_(canvas),
      wire_(wire),
      last_x_(static_cast<float>(canvas.size().samples_wide() - 1)),
      last_y_(static_cast<float>(canvas.size().samples_high() - 1)) {}

bool Rasterizer::may_cover(const std::array<ScreenPoint, 3>& corners) const {
  const auto& [a, b, c] = corners;
  const float left = std::max(0.0F, std::min({a.x, b.x, c.x}));
  const float right = std::min(last_x_, std::max({a.x, b.x, c.x}));
  if (!(left <= right) || first_not_below(left) > last_not_above(right)) return false;
  const float top = std::max(0.0F, std::min({a.y, b.y, c.y}));
  const float bottom = std::min(last_y_, std::max({a.y, b.y, c.y}));
  if (!(top <= bottom) || first_not_below(top) > last_not_above(bottom)) return false;
  return !std::isnan(a.x + b.x + c.x);  // a corner may have no position
}

Rasterizer::Facing Rasterizer::facing(const std::array<ScreenPoint, 3>& corners,
                                      bool is_back) const {
  const Vec3 a = camera_.unproject(corners[0]);
  const Vec3 normal = cross(camera_.unproject(corners[1]) - a, camera_.unproject(corners[2]) - a);
  const double size = length(normal);
  Facing made;
  made.normal = size > 0 ? normal * ((is_back ? -1 : 1) / size) : Vec3{0, 0, 1};
  made.is_back = is_back;
  made.light = light_on(made.normal);
  return made;
}

Light Rasterizer::colour_at(const Covered& triangle, const std::array<double, 3>& shares) const {
  using Kind = CornerColours::Kind;
  const CornerColours& colours = triangle.colours;
  if (colours.kind == Kind::one || colours.kind == Kind::normal) return triangle.all;
  // Shares on the surface, not on the picture (perspective correction).
  std::array<double, 3> on_surface{};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    on_surface[i] = shares[i] * triangle.nearness[i];
    sum += on_surface[i];
  }
  for (double& share : on_surface) share /= sum;
  const float light = triangle.facing.light;
  if (colours.kind == Kind::each) return blended(colours.lights, on_surface) * light;
  double value = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    value += static_cast<double>(colours.values[i]) * on_surface[i];
  }
  return light_of(colour_on_scale(colours.range.place(value))) * light;
}

/// The fraction of a sample covered by an edge: lines are a pixel wide, and fade where they would
/// touch.
float Rasterizer::wire_at(const Covered& triangle, const std::array<double, 3>& shares) const {
  const double side = canvas_.size().side;
  const double least = std::min({triangle.heights[0], triangle.heights[1], triangle.heights[2]});
  const double strength = std::clamp((least / side - 1.5) / 4.5, 0.0, 1.0);
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    nearest = std::min(nearest, shares[i] * triangle.heights[i]);
  }
  return static_cast<float>(0.8 * strength * std::clamp(0.45 * side + 0.5 - nearest, 0.0, 1.0));
}

void Rasterizer::draw(const std::array<ScreenPoint, 3>& corners, const CornerColours& colours) {
  const auto& [a, b, c] = corners;
  const double area = side_of(a, b, static_cast<double>(c.x), static_cast<double>(c.y));
  if (!(area != 0)) return;
  Covered triangle{.corners = corners, .colours = colours};
  bool is_ready = false;
  const int left = first_not_below(std::max(0.0F, std::min({a.x, b.x, c.x})));
  const int right = last_not_above(std::min(last_x_, std::max({a.x, b.x, c.x})));
  const int top = first_not_below(std::max(0.0F, std::min({a.y, b.y, c.y})));
  const int bottom = last_not_above(std::min(last_y_, std::max({a.y, b.y, c.y})));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const std::array<double, 3> shares = {side_of(b, c, x, y) / area, side_of(c, a, x, y) / area,
                                            side_of(a, b, x, y) / area};
      if (!(shares[0] >= 0 && shares[1] >= 0 && shares[2] >= 0)) continue;
      if (!is_ready) prepare(triangle, area);
      is_ready = true;
      draw_sample(triangle,
                  canvas_.place(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)),
                  shares);
    }
  }
}

/// Call only for visible triangles.
void Rasterizer::prepare(Covered& triangle, double area) const {
  const auto& [a, b, c] = triangle.corners;
  // The picture's y axis points down: counter-clockwise in the world is clockwise in the picture.
  triangle.facing = facing(triangle.corners, area > 0);
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.nearness[i] = camera_.nearness(static_cast<double>(triangle.corners[i].depth));
  }
  if (wire_ == Wire::yes) {
    const double size = std::abs(area);
    triangle.heights = {size / distance(b, c), size / distance(c, a), size / distance(a, b)};
  }
  if (triangle.colours.kind == CornerColours::Kind::normal) {
    triangle.all = light_of(colour_of_direction(camera_.axes().in_world(triangle.facing.normal)));
  } else {
    triangle.all = triangle.colours.lights[0] * triangle.facing.light;
  }
  if (is_flat(triangle)) triangle.flat = srgb_of(tinted(triangle, triangle.all));
}

/// Whether all samples of the triangle have the same colour.
bool Rasterizer::is_flat(const Covered& triangle) const {
  using Kind = CornerColours::Kind;
  const Kind kind = triangle.colours.kind;
  return wire_ == Wire::no && (kind == Kind::one || kind == Kind::normal);
}

/// Back faces are tinted.
Light Rasterizer::tinted(const Covered& triangle, Light light) {
  if (!triangle.facing.is_back || triangle.colours.kind == CornerColours::Kind::normal) {
    return light;
  }
  return {light.red * k_back_tint.red, light.green * k_back_tint.green,
          light.blue * k_back_tint.blue};
}

void Rasterizer::draw_sample(const Covered& triangle, std::uint64_t place,
                             const std::array<double, 3>& shares) {
  double depth = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    depth += shares[i] * static_cast<double>(triangle.corners[i].depth);
  }
  depth = std::clamp(depth, 0.0, 1.0);
  if (!canvas_.shows(place, depth)) return;
  if (is_flat(triangle)) return canvas_.draw(place, {depth, triangle.flat});
  Light light = tinted(triangle, colour_at(triangle, shares));
  if (wire_ == Wire::yes) {
    const float wire = wire_at(triangle, shares);
    light = light * (1 - wire) + k_wire_colour * wire;
  }
  canvas_.draw(place, {depth, srgb_of(light)});
}

}  // namespace meshfarm
