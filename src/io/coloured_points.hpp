// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/io/channel.hpp>

#include "texture_colours.hpp"

namespace meshfarm {

/// Points with the colours of textures: in their colour channels, if they have these, or else in
/// added channels after all others, where white stands for points that no texture covers.
class ColouredPoints {
 public:
  /// `textures` must outlive this.
  ColouredPoints(std::vector<Channel> channels, TextureColours& textures);

  const std::vector<Channel>& channels() const { return channels_; }
  /// Valid until the next call. `first`: the index of the batch's first vertex.
  const ChannelPoints& of(const ChannelPoints& batch, std::uint64_t first);

 private:
  std::vector<Channel> channels_;
  std::size_t added_ = 0;  // to these
  std::array<std::size_t, 3> columns_{};
  TextureColours& textures_;
  ChannelPoints made_;
};

}  // namespace meshfarm
