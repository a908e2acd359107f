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

/// The channels that a mesh has for a comparison: where it has textures, theirs are its colours.
std::vector<Channel> compared_channels(const MeshFileInfo& info);

/// A mesh in memory, with some of its compared_channels().
class ComparedMesh {
 public:
  /// `columns`: which channels; `vertices`: how many there are.
  ComparedMesh(MeshSource& source, const std::string& path, std::span<const std::size_t> columns,
               std::uint64_t vertices);
  /// Makes both tell where their labels differ. `a` and `b` say what these mean.
  static void pair_labels(ComparedMesh& a, const LabelMeaning& meaning_a, ComparedMesh& b,
                          const LabelMeaning& meaning_b);
  /// Stands as long as this does.
  ValuedMesh valued() const;

 private:
  void values_at(std::uint32_t triangle, const std::array<double, 3>& shares,
                 std::span<double> values) const;
  std::array<double, 3> colour_at(std::uint32_t triangle,
                                  const std::array<double, 3>& shares) const;

  Mesh mesh_;
  std::vector<Label> labels_;  // where these are compared: as pair_labels() numbers them
  std::vector<float> values_;  // of the vertices' own channels
  std::size_t own_ = 0;        // how many these are
  /// Of each column: which of these it is, or with k_textures added which level of the texture.
  std::vector<std::size_t> places_;
  static constexpr std::size_t k_textures = std::size_t{1} << 32;
  std::optional<MaterialColours> colours_;
};

}  // namespace meshfarm
