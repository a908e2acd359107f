// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// Channels that both meshes have and that are compared as one.
struct ChannelPair {
  std::string name;  // "colours" and "normals" for three channels, else the channel's
  ChannelRole role = ChannelRole::quality;  // normals only where all three are there
  std::size_t columns = 1;
};

/// Which channels two meshes, A and B, have in common.
struct ChannelPairs {
  std::vector<ChannelPair> pairs;
  /// The indices of the pairs' channels, pair by pair.
  std::vector<std::size_t> columns_a;
  std::vector<std::size_t> columns_b;
  /// The names of channels that only one of them has.
  std::vector<std::string> only_a;
  std::vector<std::string> only_b;
};

/// Channels are the same if their names and roles are; their types may differ.
ChannelPairs pair_channels(std::span<const Channel> a, std::span<const Channel> b);

/// The values of these channels for all vertices, of which there are `vertices` if that is known.
/// Components of colours are as colour_level() gives them, all else is unchanged.
std::vector<float> read_columns(MeshSource& source, std::span<const std::size_t> columns,
                                std::uint64_t vertices = 0);

}  // namespace meshfarm
