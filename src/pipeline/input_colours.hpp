// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/surface_places.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// What the textures of a stage's input show at the places of its surface that are nearest to given
/// points. Parts are read when they are asked for, and forgotten when their memory is needed. Safe
/// to ask from several threads.
class InputColours {
 public:
  struct Options {
    unsigned threads = 0;
    double spacing = 0;              // of the samples on the surface, a length
    double reach = 0;                // SurfacePlacesOptions::reach
    std::uint64_t memory_bytes = 0;  // of the parts that are kept, but one a thread at least
  };
  /// Reads all parts once. The manifest must be one of sorted streams, with texture coordinates and
  /// labels that are materials.
  InputColours(const Stage& stage, const Manifest& manifest, const MaterialColours& materials,
               const Options& options);

  void find(std::span<const Vec3> points, std::span<const Vec3> normals,
            std::span<BakedColour> colours);

 private:
  struct Piece {
    Mesh mesh;
    std::optional<SurfacePlaces> places;
    std::uint64_t bytes = 0;
  };
  using PiecePointer = std::shared_ptr<const Piece>;
  struct Best {
    double squared = 0;
    bool faces = false;
    BakedColour colour{};
  };

  Mesh read_part(std::size_t part) const;
  Mesh read_between() const;
  std::shared_ptr<Piece> made(Mesh mesh) const;
  PiecePointer piece(std::size_t number);
  void keep(std::size_t number, const PiecePointer& piece);
  std::vector<std::size_t> pieces_by_distance(const Box& box) const;
  BakedColour colour_at(const Piece& piece, const SurfacePlace& place) const;

  const Stage& stage_;
  const Manifest& manifest_;
  const MaterialColours& materials_;
  Options options_;
  std::vector<Box> boxes_;                   // of the pieces: the parts, and what is between them
  std::vector<std::vector<Vec3>> boundary_;  // boundary vertices of the parts
  std::vector<PiecePointer> kept_;
  std::vector<std::uint64_t> used_;  // when, counted
  std::uint64_t uses_ = 0;
  std::uint64_t bytes_ = 0;
  std::mutex mutex_;
};

}  // namespace meshfarm
