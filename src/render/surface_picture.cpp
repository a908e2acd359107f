// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cassert>
#include <vector>

#include <meshfarm/render/surface_picture.hpp>

#include "render/canvas.hpp"
#include "render/develop.hpp"
#include "render/occlusion.hpp"
#include "render/rasterizer.hpp"

namespace meshfarm {
namespace {

constexpr Srgb k_between_parts = {66, 70, 80};

/// Paints the triangles of a piece.
class PiecePainter {
 public:
  PiecePainter(const RenderOptions& options, const PiecePaint& paint) : values_(paint.values) {
    using Kind = CornerColours::Kind;
    switch (options.colour_by) {
      case ColourBy::normal:
        made_.kind = Kind::normal;
        break;
      case ColourBy::part:
        made_.lights[0] = light_of(
            paint.part == PiecePaint::k_between ? k_between_parts : colour_of_number(paint.part));
        break;
      case ColourBy::quality:
        assert(options.range);
        made_.kind = Kind::values;
        made_.range = {(*options.range)[0], (*options.range)[1]};
        break;
      default:
        made_.lights[0] = light_of(k_clay);
    }
  }
  const CornerColours& of(const Triangle& triangle) {
    if (made_.kind == CornerColours::Kind::values) {
      for (std::size_t i = 0; i < 3; ++i) made_.values[i] = values_[triangle[i]];
    }
    return made_;
  }

 private:
  std::span<const float> values_;
  CornerColours made_;
};

}  // namespace

class SurfacePicture::Impl {
 public:
  Impl(const RenderOptions& options, const Camera& camera)
      : options_(options),
        camera_(camera),
        canvas_({options.width, options.height, options.samples}),
        rasterizer_(camera_, canvas_, options.wire ? Wire::yes : Wire::no) {}

  void draw(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            const PiecePaint& paint) {
    PiecePainter painter(options_, paint);
    const auto draw_one = [&](const Triangle& t, const std::array<ScreenPoint, 3>& corners) {
      if (rasterizer_.may_cover(corners)) rasterizer_.draw(corners, painter.of(t));
    };
    // Of many vertices, as a sweep holds them, only those that are used.
    if (positions.size() > triangles.size()) {
      for (const Triangle& t : triangles) {
        draw_one(t, {camera_.project(positions[t[0]]), camera_.project(positions[t[1]]),
                     camera_.project(positions[t[2]])});
      }
      return;
    }
    std::vector<ScreenPoint> seen;
    seen.reserve(positions.size());
    for (const Vec3& p : positions) seen.push_back(camera_.project(p));
    for (const Triangle& t : triangles) draw_one(t, {seen[t[0]], seen[t[1]], seen[t[2]]});
  }

  Texels finish() {
    std::vector<float> open_sky;
    if (options_.colour_by != ColourBy::normal) {
      open_sky = find_open_sky(canvas_, camera_, options_.threads);
    }
    return develop(canvas_, open_sky, options_);
  }

 private:
  RenderOptions options_;
  Camera camera_;
  Canvas canvas_;
  Rasterizer rasterizer_;
};

SurfacePicture::SurfacePicture(const RenderOptions& options, const Camera& camera)
    : impl_(std::make_unique<Impl>(options, camera)) {}
SurfacePicture::~SurfacePicture() = default;
SurfacePicture::SurfacePicture(SurfacePicture&&) noexcept = default;

Frame SurfacePicture::frame_of(const RenderOptions& options) {
  const double side = options.samples;
  return {0, 0, side * options.width, side * options.height};
}

void SurfacePicture::draw(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const PiecePaint& paint) {
  impl_->draw(positions, triangles, paint);
}

Texels SurfacePicture::finish() {
  return impl_->finish();
}

}  // namespace meshfarm
