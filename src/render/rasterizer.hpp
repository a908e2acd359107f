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

/// What lowest and highest value a scale has.
struct ValueRange {
  double low = 0;
  double high = 0;

  double place(double value) const {
    return high > low ? (value - low) / (high - low) : 0 * value + 0.5;
  }
};

/// The colours of a triangle's corners, before light falls on them.
struct CornerColours {
  enum class Kind : std::uint8_t {
    one,     // lights[0] is that of all of it
    each,    // blended from the three lights
    values,  // by the blended value
    normal   // by the side that it faces
  };
  Kind kind = Kind::one;
  std::array<Light, 3> lights{};
  std::array<float, 3> values{};
  ValueRange range;
};

enum class Wire : std::uint8_t { no, yes };

/// Draws triangles on a canvas: each sample whose middle one covers, edges included.
class Rasterizer {
 public:
  Rasterizer(const Camera& camera, Canvas& canvas, Wire wire);

  /// Whether a sample's middle lies in the box round the corners. Most triangles of a large mesh
  /// have none.
  bool may_cover(const std::array<ScreenPoint, 3>& corners) const;
  /// Of corners that may_cover() is true for.
  void draw(const std::array<ScreenPoint, 3>& corners, const CornerColours& colours);

 private:
  struct Covered;
  struct Facing {
    Vec3 normal;  // as seen, toward the viewer
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
