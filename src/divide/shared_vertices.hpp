// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>
#include <meshfarm/util/bucket_file.hpp>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

/// Facts about a boundary vertex of a slab.
struct SharedVertex {
  std::uint32_t place = 0;   // in the share
  std::uint32_t number = 0;  // the same for welded vertices
  std::uint32_t piece = 0;   // of the slab's surface
  Vec3 position;
};

/// The boundary vertices of all slabs, in a scratch file. Visiting the triangles between slabs in
/// the order of their lowest slab needs those of few slabs at a time.
class SharedVertices {
 public:
  SharedVertices(const std::filesystem::path& folder, std::size_t slabs);
  /// Adds all of a slab, ascending by place. Safe from several threads.
  void add(std::uint32_t slab, std::span<const SharedVertex> vertices);
  void finish();

  /// Call this after finish(), from one thread. Loads the slab's vertices unless they are loaded.
  const SharedVertex& at(SharePlace vertex);
  /// Nothing below this slab will be asked for.
  void forget_below(std::uint32_t slab);

 private:
  struct Loaded {
    std::vector<SharedVertex> vertices;
    std::vector<std::uint32_t> index;  // by place
  };
  const Loaded& loaded(std::uint32_t slab);

  BucketFile file_;
  std::mutex mutex_;
  std::map<std::uint32_t, Loaded> loaded_;
};

}  // namespace meshfarm
