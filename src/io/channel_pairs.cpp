// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include <meshfarm/io/channel_pairs.hpp>

namespace meshfarm {
namespace {

std::optional<std::size_t> place_of(const Channel& channel, std::span<const Channel> channels) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& other) {
    return other.name == channel.name && other.role == channel.role;
  });
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

std::vector<std::string> names_missing(std::span<const Channel> channels,
                                       std::span<const Channel> others) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    if (!place_of(channel, others)) names.push_back(channel.name);
  }
  return names;
}

}  // namespace

ChannelPairs pair_channels(std::span<const Channel> a, std::span<const Channel> b) {
  ChannelPairs made;
  made.only_a = names_missing(a, b);
  made.only_b = names_missing(b, a);
  std::vector<bool> is_paired(a.size(), false);
  const auto add = [&](const std::string& name, ChannelRole role,
                       std::span<const std::size_t> columns) {
    made.pairs.push_back({name, role, columns.size()});
    for (const std::size_t column : columns) {
      is_paired[column] = true;
      made.columns_a.push_back(column);
      made.columns_b.push_back(*place_of(a[column], b));
    }
  };
  const auto colours = colour_columns(a);
  if (colours && colour_columns(b)) add("colours", ChannelRole::colour, *colours);
  const auto normals = normal_columns(a);
  if (normals && normal_columns(b)) add("normals", ChannelRole::normal, *normals);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (is_paired[i] || !place_of(a[i], b)) continue;
    // A single component is no direction.
    const bool is_number = a[i].role == ChannelRole::normal;
    add(a[i].name, is_number ? ChannelRole::quality : a[i].role, {&i, 1});
  }
  return made;
}

std::vector<float> read_columns(MeshSource& source, std::span<const std::size_t> columns,
                                std::uint64_t vertices) {
  const std::vector<Channel> channels = source.info().channels;
  std::vector<float> values;
  values.reserve(vertices * columns.size());
  source.scan_channels([&](const ChannelPoints& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      for (const std::size_t column : columns) {
        const float value = batch.values[i * channels.size() + column];
        const bool is_colour = channels[column].role == ChannelRole::colour;
        values.push_back(is_colour ? colour_level(channels[column].type, value) : value);
      }
    }
  });
  return values;
}

}  // namespace meshfarm
