// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

/// Which of a mesh's channels are wanted; the labels of its triangles count among them.
struct ChannelChoice {
  bool all = true;
  std::vector<std::string> names;  // if not all; "colours" and "normals" stand for their channels

  bool operator==(const ChannelChoice&) const = default;
};

/// "auto", "none", or names separated by commas. Throws UsageError for an empty name; `option` is
/// for the message.
ChannelChoice parse_choice(std::string_view text, std::string_view option);

/// The indices of the chosen channels, ascending. Throws UsageError for a name that neither a
/// channel nor the labels have, listing those that exist, and for a part of a normal.
std::vector<std::size_t> chosen_columns(const ChannelChoice& choice,
                                        std::span<const Channel> channels,
                                        const std::optional<LabelMeaning>& labels = {});

/// Whether texture coordinates are wanted: by the name "uvs".
bool chooses_uvs(const ChannelChoice& choice);

/// Whether labels are wanted, by their name.
bool chooses_labels(const ChannelChoice& choice, const LabelMeaning& labels);

/// The channels at these indices.
std::vector<Channel> channels_at(std::span<const Channel> channels,
                                 std::span<const std::size_t> columns);

/// Only the values of these columns, from values of `width` columns.
std::vector<float> values_at(std::span<const float> values, std::size_t width,
                             std::span<const std::size_t> columns);

/// The mesh with only the chosen channels and labels; the others count as skipped. Throws
/// UsageError as chosen_columns does.
std::unique_ptr<MeshSource> with_channels(std::unique_ptr<MeshSource> source,
                                          const ChannelChoice& choice);

}  // namespace meshfarm
