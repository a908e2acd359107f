// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/label_pairs.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// The channels of a mesh for a comparison: textures, if any, provide its colours.
std::vector<Channel> compared_channels(const MeshFileInfo& info);

/// A mesh in memory, with some of its compared_channels().
class ComparedMesh {
 public:
  /// `columns`: the channels to use; `vertices`: the number of vertices.
  ComparedMesh(MeshSource& source, const std::string& path, std::span<const std::size_t> columns,
               std::uint64_t vertices);
  /// Makes both report where their labels differ, given the meanings of the labels.
  static void pair_labels(ComparedMesh& a, const LabelMeaning& meaning_a, ComparedMesh& b,
                          const LabelMeaning& meaning_b);
  /// Valid as long as this object exists.
  ValuedMesh valued() const;

 private:
  void values_at(std::uint32_t triangle, const std::array<double, 3>& shares,
                 std::span<double> values) const;
  std::array<double, 3> colour_at(std::uint32_t triangle,
                                  const std::array<double, 3>& shares) const;

  Mesh mesh_;
  std::vector<Label> labels_;  // if compared: as numbered by pair_labels()
  std::vector<float> values_;  // of the vertices' own channels
  std::size_t own_ = 0;        // the number of these channels
  /// Per column: the index of such a channel or, with k_textures added, of the texture's channel.
  std::vector<std::size_t> places_;
  static constexpr std::size_t k_textures = std::size_t{1} << 32;
  std::optional<MaterialColours> colours_;
};

}  // namespace meshfarm
