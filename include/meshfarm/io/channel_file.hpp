// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/fill.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The input's channels in a stage.
struct StagedChannels {
  std::vector<Channel> channels;  // empty: there is no file
  FileRef file;
  std::uint64_t points = 0;
};

/// Stages all vertices of the source that have a position, with the values of their channels, in
/// bounded memory. A value that is not finite becomes 0. Does nothing if there are no channels.
StagedChannels stage_channels(MeshSource& source, const Stage& stage,
                              const std::function<void(std::uint64_t points)>& progress);

/// A picture of the input's materials.
struct StagedPicture {
  std::string name;  // of its original file
  FileRef file;
};

/// Stages the pictures of the source's materials, byte for byte.
std::vector<StagedPicture> stage_pictures(const MeshSource& source, const Stage& stage);

/// The pictures of a stage.
PictureFiles pictures_of(const Stage& stage, std::vector<StagedPicture> pictures);

/// Reads the file block by block. Throws DataError naming `what` for anything that stage_channels
/// did not make.
class ChannelReader {
 public:
  ChannelReader(Fill fill, const StagedChannels& staged, PositionType positions, std::string what);
  /// The next points; false after the last.
  bool next(ChannelPoints& points);

 private:
  Fill fill_;
  const StagedChannels& staged_;
  PositionType positions_;
  std::string what_;
  std::uint64_t done_ = 0;
  std::string bytes_;
};

}  // namespace meshfarm
