// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

inline constexpr std::uint64_t k_default_window = 400'000;
inline constexpr std::uint64_t k_sort_memory = std::uint64_t{512} << 20;

/// Where slabs are sorted.
enum class SortAt : std::uint8_t {
  here,  // by this process: the stage holds streams
  farm,  // by the first jobs of a run, on all hosts: the stage holds slabs
};

struct CutOptions {
  Scheme scheme = Scheme::cut;
  std::uint32_t parts = 0;  // or streams; 0: default_parts() of the input's triangles
  Weld weld = Weld::exact;  // vertices at the same position become one
  // For streams only:
  SortAt sort = SortAt::here;  // the streams are the same
  /// The number of triangles in a worker's sweep window. A sample of each longer stream is kept as
  /// a part; the cost threshold of the sweep is found from it.
  std::uint64_t window_triangles = k_default_window;

  std::string input_name;  // kept in the manifest, for people
  unsigned threads = 0;    // 0: one per core; no byte of the stage depends on it
  /// For the parts that are made at once, 0: no limit; or for sorting streams, 0: k_sort_memory.
  std::uint64_t memory_bytes = 0;
  std::uint64_t sort_memory() const { return memory_bytes > 0 ? memory_bytes : k_sort_memory; }
  std::filesystem::path scratch;  // for what does not fit into memory; empty: see scratch_folder()
  /// Told the current phase and its progress (0..1); may be empty.
  std::function<void(std::string_view phase, double done)> progress;
  const std::atomic<bool>* stop = nullptr;
};

/// Parts of about a million triangles, or streams of 1.2 million; but at least sixteen of a mesh
/// that is worth dividing.
std::uint32_t default_parts(Scheme scheme, std::uint64_t triangles);

/// Divides a mesh and publishes the results in the stage: parts, streams or slabs, the boundary
/// side file, and the manifest last. Degenerate triangles are dropped and counted. The input is
/// scanned in order and never held: vertices and triangles go to shares of it in scratch files,
/// through bounded buffers, and each share is finished in memory. Throws DataError, IoError;
/// IncompleteError when stopped.
///
/// Scheme::cut makes compact parts (Xiong et al. 2008, 3.1). They depend only on the input and on
/// options.parts and options.weld. None has more than 1.15 times the mean number of vertices,
/// however the vertices are distributed. Memory: at most a million cells (1 GB while METIS works on
/// them), and one part per thread; with memory_bytes only as many parts at once as fit into it.
///
/// Scheme::stream makes slabs of about equal size along the longest axis of the bounding box, and
/// sorts them to streams (Xiong et al. 2008, 4.1). If the input is already in order along one of
/// several equally long axes, that axis is used, and the input is not sorted again. The streams
/// depend only on the input and on parts, weld, sort_memory() and window_triangles; there are more
/// streams than asked for if a slab would not fit. With SortAt::farm the slabs are published
/// unsorted, and boundary and manifest already match the streams that jobs will make. Anonymous
/// memory stays below sort_memory(), of which 256 MB is the useful minimum.
Manifest cut_mesh(MeshSource& source, const Stage& stage, const CutOptions& options);

}  // namespace meshfarm
