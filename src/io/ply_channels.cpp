// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_channels.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace meshfarm {
namespace {

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Nothing for values that cannot be interpolated.
std::optional<ChannelRole> role_of(const PlyProperty& property) {
  static constexpr std::array<std::string_view, 13> k_colours{
      "red",  "green", "blue",        "alpha",         "r",           "g", "b", "a",
      "grey", "gray",  "diffuse_red", "diffuse_green", "diffuse_blue"};
  static constexpr std::array<std::string_view, 3> k_normals{"nx", "ny", "nz"};
  static constexpr std::array<std::string_view, 10> k_texture{
      "s", "t", "u", "v", "texture_u", "texture_v", "texture_s", "texture_t", "tex_u", "tex_v"};
  const bool is_float = !is_integer(property.type);
  if (is_one_of(k_colours, property.name)) {
    const bool is_level = property.type == PlyType::uint8 || property.type == PlyType::uint16;
    return is_float || is_level ? std::optional(ChannelRole::colour) : std::nullopt;
  }
  if (!is_float || is_one_of(k_texture, property.name)) return std::nullopt;
  return is_one_of(k_normals, property.name) ? ChannelRole::normal : ChannelRole::quality;
}

ChannelType type_of(PlyType type) {
  if (type == PlyType::uint8) return ChannelType::uint8;
  return type == PlyType::uint16 ? ChannelType::uint16 : ChannelType::float32;
}

}  // namespace

std::vector<PlyChannel> channels_of(const PlyElement& vertices) {
  std::vector<PlyChannel> channels;
  for (std::size_t i = 0; i < vertices.properties.size(); ++i) {
    const PlyProperty& property = vertices.properties[i];
    const bool is_axis =
        std::find(vertices.axes.begin(), vertices.axes.end(), i) != vertices.axes.end();
    if (is_axis || property.is_list()) continue;
    if (const auto role = role_of(property)) {
      channels.push_back({{property.name, type_of(property.type), *role}, i});
    }
  }
  // Without all three, a normal cannot be normalised.
  const auto is_normal = [](const PlyChannel& c) { return c.channel.role == ChannelRole::normal; };
  if (std::count_if(channels.begin(), channels.end(), is_normal) != 3) {
    std::erase_if(channels, is_normal);
  }
  return channels;
}

std::optional<std::size_t> label_of(const PlyElement& faces) {
  static constexpr std::array<std::string_view, 11> k_labels{
      "material_index", "material",  "label",     "region",   "segment",     "group",
      "class",          "texnumber", "object_id", "category", "component_id"};
  static constexpr std::array<std::string_view, 5> k_others{"flags", "red", "green", "blue",
                                                            "alpha"};
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < faces.properties.size(); ++i) {
    const PlyProperty& property = faces.properties[i];
    if (property.is_list() || !is_integer(property.type) || size_of(property.type) > 4) continue;
    if (is_one_of(k_labels, property.name)) return i;
    numbers.push_back(i);
  }
  const bool is_clear =
      numbers.size() == 1 && !is_one_of(k_others, faces.properties[numbers[0]].name);
  return is_clear ? std::optional(numbers[0]) : std::nullopt;
}

}  // namespace meshfarm
