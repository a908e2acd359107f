// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

struct DivideOptions {
  std::filesystem::path folder;  // for scratch files
  std::uint64_t memory_bytes = std::uint64_t{512} << 20;
  unsigned threads = 0;  // 0: one per core; no figure depends on it
};

/// A surface's topology, with coincident vertices welded, and as in the file.
struct SurfaceTopology {
  Topology welded;
  Topology as_it_is;
};

/// A mesh of any size, to be examined in bounded memory: divided into slabs like the streams of a
/// run (cut.hpp), in scratch files if it does not fit. Anonymous memory stays below memory_bytes,
/// of which 256 MB is the useful minimum, however much lies between slabs: a surface has few
/// triangles there, a foam has many.
class DividedSurface {
 public:
  /// Scans the source, which is not needed afterwards. Throws DataError or IoError.
  DividedSurface(MeshSource& source, const DivideOptions& options);
  ~DividedSurface();
  DividedSurface(DividedSurface&&) noexcept;

  const Box& box() const;
  std::uint64_t vertices() const;
  std::uint64_t not_finite() const;  // vertices with a coordinate that is not finite
  std::uint64_t dropped() const;     // triangles that have such a corner
  std::uint64_t triangles() const;   // without the dropped ones
  /// Coincident vertices are welded as in a run.
  SurfaceTopology measure_topology() const;
  /// Shows all triangles in pieces, one piece after the other.
  void show(
      const std::function<void(std::span<const Vec3>, std::span<const Triangle>)>& take) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
