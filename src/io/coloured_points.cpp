// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "coloured_points.hpp"

#include <utility>

#include "srgb.hpp"

namespace meshfarm {
namespace {

double largest_level(ChannelType type) {
  if (type == ChannelType::float32) return 1;
  return type == ChannelType::uint8 ? UINT8_MAX : UINT16_MAX;
}

}  // namespace

ColouredPoints::ColouredPoints(std::vector<Channel> channels, TextureColours& textures)
    : channels_(std::move(channels)), textures_(textures) {
  if (const auto columns = colour_columns(channels_)) {
    columns_ = *columns;
    return;
  }
  for (const char* name : {"red", "green", "blue"}) {
    columns_[added_++] = channels_.size();
    channels_.push_back({name, ChannelType::uint8, ChannelRole::colour});
  }
}

const ChannelPoints& ColouredPoints::of(const ChannelPoints& batch, std::uint64_t first) {
  made_.points = batch.points;
  made_.values.clear();
  const std::size_t read = channels_.size() - added_;
  auto from = batch.values.begin();
  for (std::size_t i = 0; i < batch.points.size(); ++i) {
    const std::size_t row = made_.values.size();
    made_.values.insert(made_.values.end(), from, from + static_cast<std::ptrdiff_t>(read));
    from += static_cast<std::ptrdiff_t>(read);
    made_.values.insert(made_.values.end(), added_, UINT8_MAX);
    const std::optional<LinearColour> colour = textures_.of(first + i);
    if (!colour) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double level = srgb_of_linear(static_cast<double>((*colour)[k]));
      made_.values[row + columns_[k]] =
          static_cast<float>(largest_level(channels_[columns_[k]].type) * level);
    }
  }
  return made_;
}

}  // namespace meshfarm
