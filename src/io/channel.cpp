// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string_view>

#include <meshfarm/io/channel.hpp>

namespace meshfarm {
namespace {

std::optional<std::size_t> column_of(std::span<const Channel> channels, ChannelRole role,
                                     std::string_view name) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) {
    return channel.role == role && channel.name == name;
  });
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

std::optional<std::array<std::size_t, 3>> columns_of(std::span<const Channel> channels,
                                                     ChannelRole role,
                                                     const std::array<std::string_view, 3>& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<std::size_t> column = column_of(channels, role, names[i]);
    if (!column) return std::nullopt;
    columns[i] = *column;
  }
  return columns;
}

}  // namespace

std::optional<std::array<std::size_t, 3>> colour_columns(std::span<const Channel> channels) {
  return columns_of(channels, ChannelRole::colour, {"red", "green", "blue"});
}

std::optional<std::array<std::size_t, 3>> normal_columns(std::span<const Channel> channels) {
  return columns_of(channels, ChannelRole::normal, {"nx", "ny", "nz"});
}

std::optional<std::size_t> alpha_column(std::span<const Channel> channels) {
  if (!colour_columns(channels)) return std::nullopt;
  return column_of(channels, ChannelRole::colour, "alpha");
}

float colour_level(ChannelType type, float value) {
  if (type == ChannelType::float32) return value;
  return rounded_to(type, value) / (type == ChannelType::uint8 ? 255.0F : 65535.0F);
}

float rounded_to(ChannelType type, float value) {
  if (!std::isfinite(value)) return 0;
  if (type == ChannelType::float32) return value;
  const float most = type == ChannelType::uint8 ? 255.0F : 65535.0F;
  return std::clamp(std::floor(value + 0.5F), 0.0F, most);
}

void repair_values(std::span<const Channel> channels, std::span<float> values) {
  if (channels.empty()) return;
  for (std::size_t first = 0; first < values.size(); first += channels.size()) {
    const std::span<float> of_vertex = values.subspan(first, channels.size());
    double squared = 0;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      of_vertex[i] = rounded_to(channels[i].type, of_vertex[i]);
      if (channels[i].role != ChannelRole::normal) continue;
      squared += static_cast<double>(of_vertex[i]) * static_cast<double>(of_vertex[i]);
    }
    if (!(squared > 0)) continue;
    const double length = std::sqrt(squared);
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].role != ChannelRole::normal) continue;
      of_vertex[i] = static_cast<float>(static_cast<double>(of_vertex[i]) / length);
    }
  }
}

AppearanceColumns::AppearanceColumns(std::span<const Channel> channels) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].role != ChannelRole::colour) continue;
    if (columns_.size() == std::tuple_size_v<Appearance>) break;
    columns_.push_back({i, channels[i].type});
  }
}

Appearance AppearanceColumns::of(std::span<const float> values) const {
  constexpr float k_range = 65535;
  Appearance made{};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto& [channel, type] = columns_[i];
    const float number = 0.5F + k_range * colour_level(type, values[channel]);
    if (number > 0) made[i] = static_cast<std::uint16_t>(std::min(number, k_range));
  }
  return made;
}

}  // namespace meshfarm
