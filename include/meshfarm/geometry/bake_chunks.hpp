// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct BakeChunkOptions {
  std::uint32_t texture_size = 2048;
  std::uint32_t margin_texels = 4;  // the margin used in baking
  /// Approximate maximum per chunk.
  std::uint64_t triangles = 65'536;
  std::uint64_t texels = std::uint64_t{1} << 20;
  std::size_t most_chunks = 1024;  // chunks are larger if necessary
};

/// Divides a surface to be baked into chunks of neighbouring triangles. The texels of all chunks
/// together equal those of the whole surface, byte by byte.
class BakeChunks {
 public:
  /// `mesh` and `uvs` must outlive it.
  BakeChunks(const Mesh& mesh, std::span<const CornerUvs> uvs, const BakeChunkOptions& options);
  /// 0 for an empty mesh.
  std::size_t size() const { return ends_.size(); }
  /// About how many texels the chunk's own triangles cover, without margins.
  std::uint64_t texels(std::size_t chunk) const { return texels_[chunk]; }
  BakeSurface surface(std::size_t chunk) const;

 private:
  struct Cells {
    std::uint32_t x0, y0, x1, y1;  // inclusive
  };
  void divide();
  void sort_into_cells();
  Cells cells_of(std::uint32_t triangle, double margin) const;
  std::span<const std::uint32_t> own(std::size_t chunk) const;
  std::vector<std::uint32_t> with_neighbours(std::size_t chunk) const;

  const Mesh& mesh_;
  std::span<const CornerUvs> uvs_;
  BakeChunkOptions options_;
  std::vector<Vec3> normals_;         // of the vertices
  std::vector<std::uint32_t> order_;  // triangles, chunk by chunk, ascending in each
  std::vector<std::size_t> ends_;     // of the chunks in it
  std::vector<std::uint64_t> texels_;
  std::uint32_t cells_a_side_ = 1;
  std::vector<std::size_t> cell_begins_;
  std::vector<std::uint32_t> in_cells_;  // triangles, cell by cell
};

}  // namespace meshfarm
