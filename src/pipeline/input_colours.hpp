// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/surface_places.hpp>
#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The colours that the textures of a stage's input show at the surface places nearest to given
/// points. Parts are read when a point may be near them, and evicted when their memory is needed.
class InputColours {
 public:
  struct Input {
    const Stage& stage;
    const SectionedFile& file;  // of the scene
    const BakeScene& scene;
    const MaterialColours& materials;
  };
  /// What `input` refers to must outlive it. `columns`: of its triangles. `memory_bytes`: for the
  /// cached parts; at least one part is kept.
  InputColours(const Input& input, const ColumnSet& columns, std::uint64_t memory_bytes);

  /// Throws DataError, IoError for parts that cannot be read.
  void find(std::span<const Vec3> points, std::span<const Vec3> normals,
            std::span<BakedColour> colours);

 private:
  /// A part, or some triangles between parts.
  struct Piece {
    Mesh mesh;
    std::optional<SurfacePlaces> places;
    std::uint64_t bytes = 0;
    std::uint64_t used = 0;  // time of the last use, counted
  };
  struct Best {
    double squared = 0;
    bool faces = false;
    BakedColour colour{};
  };

  Mesh read(std::size_t number) const;
  const Piece& piece(std::size_t number);
  void forget_oldest();
  std::vector<std::size_t> pieces_by_distance(const Box& box) const;
  BakedColour colour_at(const Piece& piece, const SurfacePlace& place) const;

  Input input_;
  ColumnSet columns_;
  std::uint64_t room_;
  std::vector<Box> boxes_;  // of the pieces: the parts, then the triangles between them
  std::vector<std::unique_ptr<Piece>> kept_;
  std::uint64_t uses_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace meshfarm
