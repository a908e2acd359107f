// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/channel_values.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/vertex_normals.hpp>
#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/staging/staged_reader.hpp>

namespace meshfarm {

namespace {

/// The input decides on which side normals point: the triangles may all face the other way.
void recompute_normals(const Mesh& mesh, std::size_t channels,
                       const std::array<std::size_t, 3>& columns, std::span<float> values) {
  std::vector<Vec3> normals = vertex_normals(mesh);
  double agreement = 0;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const std::span<const float> fitted = values.subspan(v * channels, channels);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      agreement += normals[v][static_cast<int>(axis)] * static_cast<double>(fitted[columns[axis]]);
    }
  }
  const double side = agreement < 0 ? -1 : 1;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (squared_length(normals[v]) == 0) continue;  // it has no triangle with non-zero area
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[v * channels + columns[axis]] =
          static_cast<float>(side * normals[v][static_cast<int>(axis)]);
    }
  }
}

/// The range of the values of a channel. Least squares may exceed it if few points determine a
/// vertex, or if values have a step.
struct Range {
  float lo = std::numeric_limits<float>::infinity();
  float hi = -std::numeric_limits<float>::infinity();

  void add(float value) {
    lo = std::min(lo, value);
    hi = std::max(hi, value);
  }
  float nearest(float value) const { return lo <= hi ? std::clamp(value, lo, hi) : value; }
};

void add_to(std::vector<Range>& ranges, std::span<const float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) ranges[i % ranges.size()].add(values[i]);
}

void bring_into(const std::vector<Range>& ranges, std::span<float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = ranges[i % ranges.size()].nearest(values[i]);
  }
}

}  // namespace

ChannelValues fit_channels(const Stage& stage, const Manifest& manifest, const Mesh& result,
                           const ChannelFitting& fitting,
                           const std::function<void(double done)>& progress) {
  const StagedChannels& staged = manifest.channels;
  const std::size_t width = staged.channels.size();
  const std::size_t channels = fitting.columns.size();
  ChannelValues made;
  made.channels = channels_at(staged.channels, fitting.columns);
  made.rms.assign(channels, 0);
  if (result.triangles.empty()) {
    made.values.assign(result.positions.size() * channels, 0);
    return made;
  }
  ChannelFit fit(result, {channels, staged.points, fitting.threads});
  std::vector<Range> ranges(channels);
  StagedReader file(stage, staged.file);
  ChannelReader reader([&](std::span<char> buffer) { file.fill(buffer); }, staged,
                       manifest.positions, staged.file.name);
  ChannelPoints block;
  std::uint64_t done = 0;
  while (reader.next(block)) {
    if (channels != width) block.values = values_at(block.values, width, fitting.columns);
    fit.add(block.points, block.values);
    add_to(ranges, block.values);
    done += block.points.size();
    progress(static_cast<double>(done) / static_cast<double>(staged.points));
  }
  file.expect_end();
  made.values = fit.values();
  bring_into(ranges, made.values);
  repair_values(made.channels, made.values);
  const auto normals = normal_columns(made.channels);
  if (fitting.normals == Normals::recompute && normals) {
    recompute_normals(result, channels, *normals, made.values);
  }
  made.rms = fit.rms(made.values);
  return made;
}

}  // namespace meshfarm
