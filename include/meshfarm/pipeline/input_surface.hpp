// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/part_file.hpp>

namespace meshfarm {

/// Some of the input's triangles, and vertices that include all those they use.
struct SurfacePiece {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  TriangleColumnsView columns;  // of these
  /// Vertices of triangles with non-zero area that no earlier piece of the same part has shown.
  std::span<const Vec3> fresh;
  std::uint32_t part = 0;  // the number of parts: between parts
};

/// The surface of the input, read from the stage: the parts or streams, and the triangles between
/// them. Memory: a few blocks of each stream, or one part or unsorted slab per thread.
class InputSurface {
 public:
  using Wants = std::function<bool(const Box&)>;
  using Show = std::function<void(const SurfacePiece&)>;

  /// `threads`: 0 for one per core.
  InputSurface(const Stage& stage, const Manifest& manifest, unsigned threads);
  /// Shows the pieces of all parts whose boxes are wanted, and the triangles between parts, from
  /// several threads. The first call shows all parts, as no box is known yet. The pieces of a part
  /// come in order.
  void show(const Wants& wants, const Show& show);
  /// Shows all pieces of these parts, one part after the other. Throws DataError if there are no
  /// such parts.
  static void show_parts(const Stage& stage, const Manifest& manifest,
                         std::span<const std::uint32_t> parts, const Show& show);

 private:
  void show_one(std::uint32_t part, const Show& show);
  Part read_part(std::uint32_t part) const;
  void show_part(std::uint32_t part, const Show& show);
  void show_slab(std::uint32_t part, const Show& show);
  void show_stream(std::uint32_t part, const Show& show);
  void show_between(const Wants& wants, const Show& show) const;
  Vec3 corner(const BoundaryCorner& corner) const;

  const Stage& stage_;
  const Manifest& manifest_;
  unsigned threads_;
  std::vector<Box> boxes_;                   // of the parts, once they are known
  std::vector<std::vector<Vec3>> boundary_;  // boundary vertices of the parts
};

}  // namespace meshfarm
