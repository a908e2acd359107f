// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <unordered_map>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// One share of a mesh. Vertices are in file order; boundary vertices are in any order, and some
/// are named more than once.
struct MeshShare {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> boundary;
  PositionType type = PositionType::float32;  // what all positions fit
};

/// The boundary vertices of a share by their place in it, ascending, and the number of each in the
/// part or stream that was made from the share. Coincident ones may have the same number.
struct BoundaryNumbers {
  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> numbers;
  /// How many different numbers there are; they go from 0 on.
  std::uint32_t count() const;
};

/// Divides a mesh while it is scanned, in bounded memory. The caller assigns each vertex to a
/// share. A triangle goes to the share of its vertices, or to the boundary if they are in several.
/// The map from a vertex to its share and place is a mapped scratch file, of which few pages stay
/// mapped where the input has locality, or memory too.
class MeshShares {
 public:
  struct Options {
    std::filesystem::path folder;  // for scratch files
    std::uint32_t shares = 0;
    std::uint64_t vertices = 0;  // exactly as many are added
    PositionType positions = PositionType::float32;
    std::uint64_t memory_bytes = 0;  // of what is shared out; the rest goes to scratch files
  };
  explicit MeshShares(const Options& options);

  /// The share of vertices that are left out, and with them the triangles that use one.
  static constexpr std::uint32_t k_no_share = UINT32_MAX;
  static constexpr std::uint32_t k_no_point = UINT32_MAX;
  /// The next vertices, and the share of each. Where `points` are given, those of one number lie at
  /// one point, in one share, and become one vertex here already: so a share stays small whatever
  /// many there are. Throws DataError if a share gets 2^32 vertices.
  void add_vertices(std::span<const Vec3> batch, std::span<const std::uint32_t> shares,
                    std::span<const std::uint32_t> points = {});
  /// After all vertices.
  void add_triangles(std::span<const WideTriangle> batch);
  /// After all triangles; read() is then safe from several threads.
  void finish();
  MeshShare read(std::uint32_t share) const;

  /// Vertices that became one with an earlier one.
  std::uint64_t merged() const { return merged_; }
  /// Triangles that used a vertex that was left out.
  std::uint64_t dropped() const { return dropped_; }
  /// The boundary triangles, in file order and by final numbers, one entry of `numbers` a share;
  /// those that have lost a corner by it are left out and counted.
  std::vector<BoundaryTriangle> boundary(std::span<const BoundaryNumbers> numbers,
                                         std::uint64_t& degenerate) const;

  /// The memory that holds all of a usual mesh.
  static std::uint64_t memory_for(std::uint64_t vertices, std::uint64_t triangles,
                                  PositionType positions);

 private:
  struct Place {
    std::uint32_t share = 0;
    std::uint32_t place = 0;
  };
  /// How the memory is divided; nothing for the map where it does not fit as a whole.
  struct Memory {
    explicit Memory(const Options& options);
    std::uint64_t map = 0;
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
  };
  MeshShares(const Options& options, const Memory& memory);
  void put_position(std::uint32_t share, Vec3 p);
  void forget_pages(std::size_t added);

  PositionType positions_;
  MappedFile map_;
  bool is_in_memory_;
  std::size_t since_forgotten_ = 0;
  BucketFile vertices_;
  BucketFile triangles_;  // packed
  std::vector<TrianglePacker> packers_;
  BucketFile boundary_vertices_;
  std::vector<std::uint64_t> next_;                  // place in each share
  std::unordered_map<std::uint32_t, Place> points_;  // the vertex that a point's became
  std::uint64_t added_ = 0;
  std::uint64_t merged_ = 0;
  std::uint64_t dropped_ = 0;
  std::vector<std::array<Place, 3>> boundary_;  // as the square root of the input
};

}  // namespace meshfarm
