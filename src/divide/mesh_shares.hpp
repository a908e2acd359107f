// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A vertex, given by its share and its place in it.
struct SharePlace {
  std::uint32_t share = 0;
  std::uint32_t place = 0;
  friend auto operator<=>(const SharePlace&, const SharePlace&) = default;
};
using SeamTriangle = std::array<SharePlace, 3>;

/// Triangles between shares, in file order.
struct Seams {
  std::vector<SeamTriangle> triangles;
  TriangleColumns columns;
};

/// Divides a mesh in bounded memory while it is scanned. The caller assigns each vertex to a share.
/// A triangle goes to the share of its vertices, or to the boundary if they are in several shares.
/// The map from a vertex to its share and place is in memory if it fits, else a mapped scratch
/// file, of which few pages stay mapped if the input has locality.
class MeshShares {
 public:
  /// Which of the boundary triangles will be asked for: seam() only, or region() too.
  enum class SeamsFor : std::uint8_t { shares, shares_and_regions };
  struct Options {
    std::filesystem::path folder;  // for scratch files
    std::uint32_t shares = 0;
    std::uint64_t vertices = 0;  // exactly this many are added
    PositionType positions = PositionType::float32;
    std::uint64_t memory_bytes = 0;  // for map and shares; the rest goes to scratch files
    SeamsFor seams = SeamsFor::shares_and_regions;
    bool appearances = false;     // whether vertices have any
    ColumnSet columns = {};       // of the triangles
    std::uint64_t triangles = 0;  // approximate number
  };
  explicit MeshShares(const Options& options);

  /// The share of vertices that are left out, together with all triangles that use them.
  static constexpr std::uint32_t k_no_share = UINT32_MAX;
  static constexpr std::uint32_t k_no_point = UINT32_MAX;
  /// Adds the next vertices, with the share of each. If `points` are given, those with the same
  /// number lie at one point, in one share, and are merged immediately, so a share stays small
  /// however many there are. Throws DataError if a share gets 2^32 vertices.
  void add_vertices(const VertexView& batch, std::span<const std::uint32_t> shares,
                    std::span<const std::uint32_t> points = {});
  /// Call this after all vertices. Triangles whose corners are all one vertex are left out: there
  /// may be any number of them at one point, as in a file with a hole of zeros.
  void add_triangles(const TriangleView& triangles);
  /// Call this after all triangles; read() is then safe from several threads.
  void finish();
  /// For exact welding the share includes what stays apart at the seams, where a share alone does
  /// not have all triangles of a vertex: this is decided from all of them, so it is the same for
  /// any shares.
  MeshShare read(std::uint32_t share, Weld weld) const;

  /// The boundary triangles that have a corner in this share, in file order; thread-safe like
  /// read().
  std::vector<SeamTriangle> seam(std::uint32_t share) const;
  /// The boundary triangles of a region of the shares (regions.hpp); thread-safe like read(). Not
  /// for SeamsFor::shares.
  Seams region(std::uint32_t region) const;

  /// The size of the buffers before finish(): the process may keep that memory in fragments of
  /// little use.
  std::uint64_t buffer_bytes() const {
    const std::uint64_t files = 3U + (columns_.labels ? 1U : 0U) + (columns_.uvs ? 1U : 0U);
    return files * BucketFile::k_all_buffers_bytes;
  }
  /// Vertices that were merged into an earlier one.
  std::uint64_t merged() const { return merged_; }
  /// Triangles that used a vertex that was left out.
  std::uint64_t dropped() const { return dropped_; }
  /// Triangles whose corners were all one vertex.
  std::uint64_t points_left_out() const { return points_left_out_; }
  /// The memory for a typical mesh as a whole, regardless of options.memory_bytes.
  static std::uint64_t memory_for(const Options& options);

 private:
  /// How the memory is divided; 0 for the map if it does not fit as a whole.
  struct Memory {
    explicit Memory(const Options& options);
    std::uint64_t map = 0;
    std::uint64_t vertices = 0;
    std::uint64_t appearances = 0;
    std::uint64_t labels = 0;
    std::uint64_t uvs = 0;
    std::uint64_t triangles = 0;
  };
  /// The vertex that a point's vertices became, and the least of their appearances.
  struct PointVertex {
    SharePlace place;
    Appearance least{};
  };
  MeshShares(const Options& options, const Memory& memory);
  void put_position(std::uint32_t share, Vec3 p);
  void put_seam_triangle(const SeamTriangle& t, const TriangleColumnsView& columns,
                         std::size_t place);
  Vec3 position_of(SharePlace vertex) const;
  void forget_pages(std::size_t added);

  /// A file for the values of the boundary triangles by region, or none.
  BucketFile by_region(const Options& options, bool wanted) const;

  PositionType positions_;
  std::optional<Regions> regions_;
  MappedFile map_;
  bool is_in_memory_;
  bool has_appearances_;
  ColumnSet columns_;
  std::size_t since_forgotten_ = 0;
  BucketFile vertices_;
  BucketFile appearances_;
  BucketFile labels_;
  BucketFile uvs_;
  BucketFile triangles_;  // packed
  std::vector<TrianglePacker> packers_;
  BucketFile seams_;  // the boundary triangles at each share
  BucketFile region_seams_;
  BucketFile region_labels_;
  BucketFile region_uvs_;
  std::vector<std::uint64_t> next_;  // next place in each share
  std::unordered_map<std::uint32_t, PointVertex> points_;
  std::uint64_t added_ = 0;
  std::uint64_t merged_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t points_left_out_ = 0;
};

}  // namespace meshfarm
