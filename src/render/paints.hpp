// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/render/render.hpp>

#include "render/colours.hpp"
#include "render/rasterizer.hpp"

namespace meshfarm {

/// Which data of a mesh colours its triangles, and how.
class Paints {
 public:
  enum class From : std::uint8_t {
    nothing,
    normals,    // of triangles
    labels,     // of triangles
    materials,  // of triangles, by the materials' own colours
    colours,    // of vertices: red, green and blue
    pieces,     // of vertices, numbered by the renderer
    values,     // of vertices: one channel
    heights     // of vertices
  };

  /// Throws DataError if the mesh lacks the data to be coloured by.
  Paints(const MeshFileInfo& info, const RenderOptions& options);

  From from() const { return from_; }
  /// Whether each vertex has a paint: 32 bits, a packed colour or a float.
  bool are_of_vertices() const { return from_ >= From::colours; }
  bool are_of_channels() const { return from_ == From::colours || from_ == From::values; }
  /// Whether paints are numbers on a scale.
  bool have_scale() const { return from_ == From::values || from_ == From::heights; }
  const std::string& name() const { return name_; }
  const ValueRange& range() const { return range_; }

  /// The paint of a vertex with these values of all channels.
  std::uint32_t of(Vec3 vertex, std::span<const float> values) const;
  /// Extends the range, if none was given. Values that are not finite are ignored.
  void look_at(std::span<const Vec3> points, std::span<const float> values);
  /// Throws DataError if no value was finite.
  void finish_range();

  /// The colours of a triangle, given the paints of its corners if vertices have any.
  CornerColours of_triangle(Label label, const std::array<std::uint32_t, 3>& corners) const;

 private:
  void choose(const MeshFileInfo& info, const RenderOptions& options);
  void choose_colours(const MeshFileInfo& info);
  float value_of(Vec3 vertex, std::span<const float> values) const;
  void choose_channel(const MeshFileInfo& info, const RenderOptions& options);

  From from_ = From::nothing;
  std::string mesh_;  // for messages
  Vec3 up_;
  std::string name_;
  std::size_t channels_ = 0;
  std::array<std::size_t, 3> columns_{};  // of the colours; or the first is of the values
  std::array<ChannelType, 3> types_{};
  std::vector<Light> materials_;
  bool is_range_given_ = false;
  ValueRange range_{HUGE_VAL, -HUGE_VAL};
};

}  // namespace meshfarm
