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

/// Where slabs are sorted.
enum class SortAt : std::uint8_t {
  here,  // by this process: the stage holds streams
  farm,  // by the first jobs of a run, on all hosts: the stage holds slabs
};

struct StreamOptions {
  std::uint32_t streams = 0;   // 0: default_streams() of the input's triangles
  Weld weld = Weld::exact;     // vertices at the same position become one
  SortAt sort = SortAt::here;  // the streams are the same
  std::uint64_t memory_bytes = std::uint64_t{512} << 20;
  /// How many triangles a worker's sweep holds at once. A sample of each longer stream is kept as a
  /// part; from it the cost threshold of the sweep is found.
  std::uint64_t window_triangles = k_default_window;
  std::string input_name;         // kept in the manifest, for people
  unsigned threads = 0;           // 0: one a core; the streams do not depend on it
  std::filesystem::path scratch;  // for what does not fit; empty: see scratch_folder()
  /// Told what is being done and how far it is (0..1); may be empty.
  std::function<void(std::string_view phase, double done)> progress;
  const std::atomic<bool>* stop = nullptr;
};

/// Streams of about 1.2 million triangles, but a few of any mesh that is worth dividing.
std::uint32_t default_streams(std::uint64_t triangles);

/// Sorts a mesh along the longest axis of its bounding box and divides it into streams of about
/// equal size (Xiong et al. 2008, 4.1), which it publishes in the stage with the boundary side
/// file, the manifest last. If the input is already in order along one of several equally long
/// axes, that axis is taken, and the input is not sorted again. The streams depend on the input and
/// on streams, weld, memory_bytes and window_triangles only. With SortAt::farm the slabs are
/// published as they come, and boundary and manifest already fit the streams that jobs will make.
///
/// Out of core: vertices and triangles go to scratch files by slabs along the axis, through bounded
/// buffers, and every slab is sorted in memory and becomes a stream; there are more streams than
/// asked for where a slab would not fit. Anonymous memory stays below memory_bytes, of which 256 MB
/// is the least that is useful; the index map is a mapped scratch file. Throws DataError, IoError;
/// IncompleteError when stopped.
Manifest generate_streams(MeshSource& source, const Stage& stage, const StreamOptions& options);

}  // namespace meshfarm
