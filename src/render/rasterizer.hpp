// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <meshfarm/render/camera.hpp>

#include "render/canvas.hpp"
#include "render/colours.hpp"

namespace meshfarm {

/// The lowest and highest value of a scale.
struct ValueRange {
  double low = 0;
  double high = 0;

  double place(double value) const {
    return high > low ? (value - low) / (high - low) : 0 * value + 0.5;
  }
};

/// The colours of a triangle's corners, before lighting.
struct CornerColours {
  enum class Kind : std::uint8_t {
    one,     // lights[0] for the whole triangle
    each,    // interpolated from the three lights
    values,  // by the interpolated value
    normal   // by the triangle's facing
  };
  Kind kind = Kind::one;
  std::array<Light, 3> lights{};
  std::array<float, 3> values{};
  ValueRange range;
};

enum class Wire : std::uint8_t { no, yes };

/// Draws triangles on a canvas: each sample whose centre a triangle covers, edges included.
class Rasterizer {
 public:
  Rasterizer(const Camera& camera, Canvas& canvas, Wire wire);

  /// Whether a sample's centre lies in the corners' bounding box. For most triangles of a large
  /// mesh none does.
  bool may_cover(const std::array<ScreenPoint, 3>& corners) const;
  /// Requires that may_cover() is true for the corners.
  void draw(const std::array<ScreenPoint, 3>& corners, const CornerColours& colours);

 private:
  struct Covered;
  struct Facing {
    Vec3 normal;  // in view coordinates, toward the viewer
    bool is_back = false;
    float light = 0;
  };

  Facing facing(const std::array<ScreenPoint, 3>& corners, bool is_back) const;
  void prepare(Covered& triangle, double area) const;
  void draw_sample(const Covered& triangle, std::uint64_t place,
                   const std::array<double, 3>& shares);
  bool is_flat(const Covered& triangle) const;
  static Light tinted(const Covered& triangle, Light light);
  Light colour_at(const Covered& triangle, const std::array<double, 3>& shares) const;
  float wire_at(const Covered& triangle, const std::array<double, 3>& shares) const;

  const Camera& camera_;
  Canvas& canvas_;
  Wire wire_;
  float last_x_;
  float last_y_;
};

}  // namespace meshfarm
