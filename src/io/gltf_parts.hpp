// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <meshfarm/io/labels.hpp>

#include "gltf_document.hpp"
#include "label_materials.hpp"
#include "scratch_array.hpp"

namespace meshfarm {

/// Collects triangles in any order and writes them material by material. They are kept in up to 96
/// MB of memory, or in scratch files.
class GltfParts {
 public:
  GltfParts(const LabelMeaning& meaning, std::uint64_t triangles);

  void add(const TriangleView& batch);
  /// To be called after the last add(): the materials in use, each with its number of triangles.
  std::vector<GltfPart> finish(const std::filesystem::path& path);
  /// The indices of the triangles, in the same order, with `index_bytes` bytes each.
  void write(std::size_t index_bytes, const std::function<void(std::string_view)>& to);

 private:
  using Corners = std::array<std::uint32_t, 3>;
  struct Labelled {
    Corners corners{};
    std::uint32_t place = 0;  // of the material
  };
  void sort();

  LabelMaterials materials_;
  ScratchArray<Labelled> triangles_;
  ScratchArray<Corners> sorted_;
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> counts_;  // of each material
};

}  // namespace meshfarm
