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

/// The colours of a piece of a surface; else it is clay, or coloured by ColourBy::normal.
struct PiecePaint {
  static constexpr std::uint32_t k_between = UINT32_MAX;  // the part of what lies between parts

  std::uint32_t part = k_between;      // with ColourBy::part
  std::span<const float> values = {};  // per vertex, with ColourBy::quality
};

/// A picture of a surface that arrives in pieces, each with its own vertices, with a given camera.
/// Only the canvas is kept: several views can be drawn as pieces arrive. The picture does not
/// depend on the order of the pieces. options.colour_by is none, normal, part or quality; the last
/// needs a range.
class SurfacePicture {
 public:
  /// The camera must be made for the frame from frame_of().
  SurfacePicture(const RenderOptions& options, const Camera& camera);
  ~SurfacePicture();
  SurfacePicture(SurfacePicture&&) noexcept;

  static Frame frame_of(const RenderOptions& options);
  /// Adds another colouring of the same view. Call before drawing; returns the number of the look.
  std::size_t add_look(ColourBy colour_by);
  /// Thread-safe.
  void draw(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            const PiecePaint& paint = {});
  /// Draws in several pictures, which is faster than one after another.
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
