// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include <meshfarm/geometry/mesh.hpp>

#include "corner_wedges.hpp"
#include "gltf_document.hpp"
#include "scratch_array.hpp"
#include "scratch_list.hpp"

namespace meshfarm {

/// The encoded vertices of a glTF, kept until all triangles are known. A vertex with several
/// texture coordinates is split: the first keeps its index, the others follow after all vertices.
class KeptVertices {
 public:
  /// Throws IoError.
  explicit KeptVertices(const GltfLayout& layout);

  void add(std::string_view bytes);
  /// To be called after the last add(): the vertex with these texture coordinates.
  std::uint64_t split(std::uint64_t vertex, Uv uv);
  std::uint64_t count() const { return count_ + split_.size(); }
  void write(const std::function<void(std::string_view)>& to);

 private:
  struct Split {
    Uv uv{};
    std::uint64_t vertex = 0;  // the other bytes are copied from it
  };
  char* row(std::uint64_t vertex) { return bytes_.items().data() + vertex * row_bytes_; }

  std::uint64_t count_;
  std::size_t row_bytes_;
  std::size_t uv_at_;
  ScratchArray<char> bytes_;
  std::uint64_t added_ = 0;             // bytes
  std::optional<CornerWedges> wedges_;  // if there are texture coordinates
  ScratchList<Split> split_;
};

}  // namespace meshfarm
