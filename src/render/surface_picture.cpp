// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <memory>
#include <vector>

#include <meshfarm/render/surface_picture.hpp>

#include "render/canvas.hpp"
#include "render/develop.hpp"
#include "render/occlusion.hpp"
#include "render/rasterizer.hpp"
#include "render/sample_cells.hpp"

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
  Impl(const RenderOptions& options, const Camera& camera) : camera_(camera) { add_look(options); }

  std::size_t add_look(ColourBy colour_by) {
    RenderOptions options = looks_.front()->options;
    options.colour_by = colour_by;
    add_look(options);
    return looks_.size() - 1;
  }

  const Camera& camera() const { return camera_; }

  std::vector<PiecePainter> painters(const PiecePaint& paint) const {
    std::vector<PiecePainter> made;
    for (const auto& look : looks_) made.emplace_back(look->options, paint);
    return made;
  }

  void draw(std::span<const Vec3> positions, const Triangle& t,
            std::vector<PiecePainter>& painters) {
    const std::array<ScreenPoint, 3> corners = {camera_.project(positions[t[0]]),
                                                camera_.project(positions[t[1]]),
                                                camera_.project(positions[t[2]])};
    if (!looks_.front()->rasterizer.may_cover(corners)) return;
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      looks_[i]->rasterizer.draw(corners, painters[i].of(t));
    }
  }

  Texels finish(std::size_t number) {
    const Look& look = *looks_[number];
    if (look.options.colour_by == ColourBy::normal) return develop(look.canvas, {}, look.options);
    // All looks have the same depths.
    if (open_sky_.empty()) open_sky_ = find_open_sky(look.canvas, camera_, look.options);
    return develop(look.canvas, open_sky_, look.options);
  }

 private:
  struct Look {
    Look(const RenderOptions& with, const Camera& camera)
        : options(with),
          canvas({with.width, with.height, with.samples}),
          rasterizer(camera, canvas, with.wire ? Wire::yes : Wire::no) {}
    RenderOptions options;
    Canvas canvas;
    Rasterizer rasterizer;
  };

  void add_look(const RenderOptions& options) {
    looks_.push_back(std::make_unique<Look>(options, camera_));
  }

  Camera camera_;
  std::vector<std::unique_ptr<Look>> looks_;
  std::vector<float> open_sky_;
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
  SurfacePicture* const self = this;
  draw_in_all({&self, 1}, positions, triangles, paint);
}

void SurfacePicture::draw_in_all(std::span<SurfacePicture* const> pictures,
                                 std::span<const Vec3> positions,
                                 std::span<const Triangle> triangles, const PiecePaint& paint) {
  if (pictures.size() > SampleCells::k_most_cameras) {
    draw_in_all(pictures.subspan(SampleCells::k_most_cameras), positions, triangles, paint);
    pictures = pictures.first(SampleCells::k_most_cameras);
  }
  std::vector<const Camera*> cameras;
  std::vector<std::vector<PiecePainter>> painters;
  for (const SurfacePicture* const each : pictures) {
    cameras.push_back(&each->impl_->camera());
    painters.push_back(each->impl_->painters(paint));
  }
  // If there are many vertices, as in a sweep, project only those that are used.
  if (positions.size() > triangles.size()) {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      for (const Triangle& t : triangles) pictures[i]->impl_->draw(positions, t, painters[i]);
    }
    return;
  }
  const SampleCells cells(cameras, positions);
  for (const Triangle& t : triangles) {
    for (unsigned left = cells.may_cover(t); left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      pictures[i]->impl_->draw(positions, t, painters[i]);
    }
  }
}

std::size_t SurfacePicture::add_look(ColourBy colour_by) {
  return impl_->add_look(colour_by);
}

Texels SurfacePicture::finish(std::size_t look) {
  return impl_->finish(look);
}

}  // namespace meshfarm
