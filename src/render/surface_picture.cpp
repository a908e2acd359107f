// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cassert>
#include <cstdint>
#include <memory>
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
  Impl(const RenderOptions& options, const Camera& camera) : camera_(camera) { add_look(options); }

  std::size_t add_look(ColourBy colour_by) {
    RenderOptions options = looks_.front()->options;
    options.colour_by = colour_by;
    add_look(options);
    return looks_.size() - 1;
  }

  void draw(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            const PiecePaint& paint) {
    std::vector<PiecePainter> painters;
    for (const auto& look : looks_) painters.emplace_back(look->options, paint);
    const auto draw_one = [&](const Triangle& t, const std::array<ScreenPoint, 3>& corners) {
      if (!looks_.front()->rasterizer.may_cover(corners)) return;
      for (std::size_t i = 0; i < looks_.size(); ++i) {
        looks_[i]->rasterizer.draw(corners, painters[i].of(t));
      }
    };
    // Of many vertices, as a sweep holds them, only those that are used.
    if (positions.size() > triangles.size()) {
      for (const Triangle& t : triangles) {
        draw_one(t, {camera_.project(positions[t[0]]), camera_.project(positions[t[1]]),
                     camera_.project(positions[t[2]])});
      }
      return;
    }
    // Those of most triangles of a large mesh lie between the same middles of samples: these cover
    // none, and their corners need not be kept.
    const std::vector<Cell> cells = cells_of(camera_, positions);
    for (const Triangle& t : triangles) {
      if (is_one_cell(cells[t[0]], cells[t[1]], cells[t[2]])) continue;
      draw_one(t, {camera_.project(positions[t[0]]), camera_.project(positions[t[1]]),
                   camera_.project(positions[t[2]])});
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

  /// Between which columns of middles of samples a vertex lies (the upper half), and which rows.
  using Cell = std::uint32_t;
  static constexpr std::uint32_t k_anywhere = 0xffff;  // on one, or far off

  static std::uint32_t place(float x) {
    constexpr auto k_far = static_cast<float>(k_anywhere);
    const float near = x > 0 ? (x < k_far ? x : k_far) : 0;  // 0 for what is not a number
    const auto whole = static_cast<std::int32_t>(near);
    // What is at 0 or far off is whole, too.
    const auto known = -static_cast<std::uint32_t>(near != static_cast<float>(whole));
    return (static_cast<std::uint32_t>(whole) | ~known) & k_anywhere;
  }
  /// Without branches, which would be guessed wrong.
  static std::vector<Cell> cells_of(const Camera& camera, std::span<const Vec3> positions) {
    std::vector<Cell> cells(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const ScreenPoint p = camera.project(positions[i]);
      cells[i] = place(p.x) << 16 | place(p.y);
    }
    return cells;
  }
  /// Whether three are surely between the same columns, or rows.
  static bool is_one_cell(Cell a, Cell b, Cell c) {
    // Without branches, which would be guessed wrong often.
    const Cell differs = (a ^ b) | (a ^ c);
    const auto same = [](bool is_same, bool is_known) {
      return static_cast<unsigned>(is_same) & static_cast<unsigned>(is_known);
    };
    return (same(differs >> 16 == 0, a >> 16 != k_anywhere) |
            same((differs & k_anywhere) == 0, (a & k_anywhere) != k_anywhere)) != 0;
  }

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
  impl_->draw(positions, triangles, paint);
}

std::size_t SurfacePicture::add_look(ColourBy colour_by) {
  return impl_->add_look(colour_by);
}

Texels SurfacePicture::finish(std::size_t look) {
  return impl_->finish(look);
}

}  // namespace meshfarm
