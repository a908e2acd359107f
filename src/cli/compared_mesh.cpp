// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/compared_mesh.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/io/channel_pairs.hpp>

namespace meshfarm {
namespace {

bool has_textures(const MeshFileInfo& info) {
  return info.uvs && info.labels && !info.pictures.names.empty();
}

/// The channels of the vertices that are compared.
std::vector<std::size_t> own_columns(const MeshFileInfo& info) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < info.channels.size(); ++i) {
    const bool is_colour = info.channels[i].role == ChannelRole::colour;
    if (!is_colour || !has_textures(info)) columns.push_back(i);
  }
  return columns;
}

}  // namespace

std::vector<Channel> compared_channels(const MeshFileInfo& info) {
  std::vector<Channel> channels;
  for (const std::size_t column : own_columns(info)) channels.push_back(info.channels[column]);
  if (!has_textures(info)) return channels;
  for (const char* const name : {"red", "green", "blue"}) {
    channels.push_back({name, ChannelType::uint8, ChannelRole::colour});
  }
  return channels;
}

ComparedMesh::ComparedMesh(MeshSource& source, const std::string& path,
                           std::span<const std::size_t> columns, std::uint64_t vertices)
    : mesh_(read_mesh(source)) {
  const std::vector<std::size_t> own = own_columns(source.info());
  std::vector<std::size_t> wanted;
  for (const std::size_t column : columns) {
    if (column >= own.size()) {
      places_.push_back(k_textures + column - own.size());
      continue;
    }
    places_.push_back(wanted.size());
    wanted.push_back(own[column]);
  }
  own_ = wanted.size();
  values_ = read_columns(source, wanted, vertices);
  if (own_ == places_.size()) return;
  const MeshFileInfo& info = source.info();
  colours_.emplace(*info.labels, info.pictures, MaterialColours::Options{.name = path});
}

void ComparedMesh::pair_labels(ComparedMesh& a, const LabelMeaning& meaning_a, ComparedMesh& b,
                               const LabelMeaning& meaning_b) {
  MeantLabels of_a{meaning_a, a.mesh_.columns.labels};
  MeantLabels of_b{meaning_b, b.mesh_.columns.labels};
  meshfarm::pair_labels(of_a, of_b);
  a.labels_ = std::move(of_a.labels);
  b.labels_ = std::move(of_b.labels);
}

ValuedMesh ComparedMesh::valued() const {
  if (!colours_) return {mesh_, values_, {}, labels_};
  return {mesh_, values_,
          [this](std::uint32_t triangle, const std::array<double, 3>& shares,
                 std::span<double> values) { values_at(triangle, shares, values); },
          labels_};
}

void ComparedMesh::values_at(std::uint32_t triangle, const std::array<double, 3>& shares,
                             std::span<double> values) const {
  const std::array<double, 3> colour = colour_at(triangle, shares);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i] >= k_textures) {
      values[i] = colour[places_[i] - k_textures];
      continue;
    }
    values[i] = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (shares[k] == 0) continue;
      const std::size_t vertex = mesh_.triangles[triangle][k];
      values[i] += shares[k] * static_cast<double>(values_[vertex * own_ + places_[i]]);
    }
  }
}

std::array<double, 3> ComparedMesh::colour_at(std::uint32_t triangle,
                                              const std::array<double, 3>& shares) const {
  const CornerUvs& corners = mesh_.columns.uvs[triangle];
  Uv uv{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += shares[k] * static_cast<double>(corners[k][axis]);
    uv[axis] = static_cast<float>(sum);
  }
  const std::array<float, 3> linear = colours_->at(mesh_.columns.labels[triangle], uv, 1);
  std::array<double, 3> levels{};
  std::transform(linear.begin(), linear.end(), levels.begin(),
                 [](float level) { return srgb_level(static_cast<double>(level)); });
  return levels;
}

}  // namespace meshfarm
