// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/channel.hpp>

#include "ply_header.hpp"

namespace meshfarm {

/// A channel and its property of the vertices.
struct PlyChannel {
  Channel channel;
  std::size_t property = 0;
};

/// The properties of the vertices that can be interpolated: colours, normals, and other floats, but
/// not texture coordinates, which are discontinuous at seams, nor whole numbers, which may be
/// labels.
std::vector<PlyChannel> channels_of(const PlyElement& vertices);

/// The property of the faces that is a label: by its name, or because no other is a whole number.
/// Nothing if there is none.
std::optional<std::size_t> label_of(const PlyElement& faces);

/// Collects points and their values and hands them on in batches.
class ChannelBatch {
 public:
  using Take = std::function<void(const ChannelPoints&)>;

  explicit ChannelBatch(Take take) : take_(std::move(take)) {}

  void add(Vec3 point, std::span<const float> values) {
    batch_.points.push_back(point);
    batch_.values.insert(batch_.values.end(), values.begin(), values.end());
    if (batch_.points.size() == k_most_points) flush();
  }
  void flush() {
    if (!batch_.points.empty()) take_(batch_);
    batch_.points.clear();
    batch_.values.clear();
  }

 private:
  static constexpr std::size_t k_most_points = 65'536;
  Take take_;
  ChannelPoints batch_;
};

/// The data of a vertex that are read: its position and its channels' values.
class ChannelRow {
 public:
  ChannelRow(const PlyElement& vertices, std::span<const PlyChannel> channels)
      : slots_(vertices.properties.size(), k_none),
        row_(3 + channels.size()),
        values_(channels.size()) {
    for (std::size_t axis = 0; axis < 3; ++axis) slots_[vertices.axes[axis]] = axis;
    for (std::size_t i = 0; i < channels.size(); ++i) slots_[channels[i].property] = 3 + i;
  }
  bool wants(std::size_t property) const { return slots_[property] != k_none; }
  bool is_axis(std::size_t property) const { return slots_[property] < 3; }
  void set(std::size_t property, double value) { row_[slots_[property]] = value; }
  void add_to(ChannelBatch& batch) {
    std::transform(row_.begin() + 3, row_.end(), values_.begin(),
                   [](double value) { return static_cast<float>(value); });
    const Vec3 p{row_[0], row_[1], row_[2]};
    batch.add(is_finite(p) ? p : k_no_position, values_);
  }

 private:
  static constexpr std::size_t k_none = SIZE_MAX;
  std::vector<std::size_t> slots_;  // of each property: its index in the row
  std::vector<double> row_;         // the position, then the channels
  std::vector<float> values_;
};

}  // namespace meshfarm
