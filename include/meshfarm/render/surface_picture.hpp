// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/png_file.hpp>
#include <meshfarm/render/camera.hpp>
#include <meshfarm/render/render.hpp>

namespace meshfarm {

/// What colours a piece of a surface; else it is of clay, or coloured by ColourBy::normal.
struct PiecePaint {
  static constexpr std::uint32_t k_between = UINT32_MAX;  // the part of what is between parts

  std::uint32_t part = k_between;      // with ColourBy::part
  std::span<const float> values = {};  // of the vertices, with ColourBy::quality
};

/// A picture of a surface that comes in pieces, each with its own vertices, by a camera that is
/// known. Nothing is kept but the canvas: several views can be drawn as pieces come. The picture
/// does not depend on the order of pieces. options.colour_by is none, normal, part or quality; the
/// last with a range.
class SurfacePicture {
 public:
  /// The camera must be made for the frame of frame_of().
  SurfacePicture(const RenderOptions& options, const Camera& camera);
  ~SurfacePicture();
  SurfacePicture(SurfacePicture&&) noexcept;

  static Frame frame_of(const RenderOptions& options);
  /// Draws the same view in other colours, too. Call this first; returns the number of that look.
  std::size_t add_look(ColourBy colour_by);
  /// From any number of threads at once.
  void draw(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            const PiecePaint& paint = {});
  /// The same in several pictures, which takes less time than one after the other.
  static void draw_in_all(std::span<SurfacePicture* const> pictures,
                          std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const PiecePaint& paint = {});
  /// Develops a look, without a legend. Call this last.
  Texels finish(std::size_t look = 0);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
