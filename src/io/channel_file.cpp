// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The channels' file, version 1: consecutive blocks, each sealed (staging/sealed.hpp) as kind
// "CHAN". The manifest has the channels, the type of the positions and the number of points.
//   block = points u32, 65536 but in the last block | positions, 3 numbers a point
//           | the values of each channel by itself, in its type
#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_channel_kind = {'C', 'H', 'A', 'N'};
constexpr std::uint32_t k_channel_version = 1;
constexpr std::size_t k_most_points = 65'536;
constexpr std::size_t k_sum_bytes = 8;

template <class T>
void put_values(ByteWriter& out, std::span<const float> values, std::size_t first,
                std::size_t step) {
  for (; first < values.size(); first += step) out.put(static_cast<T>(values[first]));
}

/// Appends the values of one channel.
void put_values(ByteWriter& out, ChannelType type, std::span<const float> values,
                std::size_t channel, std::size_t channels) {
  switch (type) {
    case ChannelType::uint8:
      return put_values<std::uint8_t>(out, values, channel, channels);
    case ChannelType::uint16:
      return put_values<std::uint16_t>(out, values, channel, channels);
    case ChannelType::float32:
      return put_values<float>(out, values, channel, channels);
  }
}

template <class T>
void get_values(ByteReader& in, std::span<float> values, std::size_t first, std::size_t step) {
  const auto read = in.get_array<T>(values.size() / step);
  for (const T value : read) {
    values[first] = static_cast<float>(value);
    first += step;
  }
}

void get_values(ByteReader& in, ChannelType type, std::span<float> values, std::size_t channel,
                std::size_t channels) {
  switch (type) {
    case ChannelType::uint8:
      return get_values<std::uint8_t>(in, values, channel, channels);
    case ChannelType::uint16:
      return get_values<std::uint16_t>(in, values, channel, channels);
    case ChannelType::float32:
      return get_values<float>(in, values, channel, channels);
  }
}

std::string encode_block(std::span<const Vec3> points, std::span<const float> values,
                         std::span<const Channel> channels, PositionType positions) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(points.size()));
  put_positions(out, points, positions);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    put_values(out, channels[c].type, values, c, channels.size());
  }
  return seal(k_channel_kind, k_channel_version, out.bytes());
}

/// Fills every block but the last, whatever the batches of points are: the file must be the same
/// with any number of threads.
class BlockWriter {
 public:
  BlockWriter(StagedWriter& file, const StagedChannels& staged, PositionType positions)
      : file_(file), channels_(staged.channels), positions_(positions) {}

  void add(const ChannelPoints& batch) {
    const std::size_t width = channels_.size();
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      if (!has_position(batch.points[i])) continue;
      points_.push_back(batch.points[i]);
      for (std::size_t c = 0; c < width; ++c) {
        values_.push_back(rounded_to(channels_[c].type, batch.values[i * width + c]));
      }
      if (points_.size() == k_most_points) finish();
    }
  }

  /// Writes the current block, which may not be full.
  void finish() {
    if (points_.empty()) return;
    file_.write(encode_block(points_, values_, channels_, positions_));
    written_ += points_.size();
    points_.clear();
    values_.clear();
  }

  std::uint64_t points() const { return written_ + points_.size(); }

 private:
  StagedWriter& file_;
  std::span<const Channel> channels_;
  PositionType positions_;
  std::vector<Vec3> points_;
  std::vector<float> values_;
  std::uint64_t written_ = 0;
};

}  // namespace

StagedChannels stage_channels(MeshSource& source, const Stage& stage,
                              const std::function<void(std::uint64_t points)>& progress) {
  StagedChannels staged;
  staged.channels = source.info().channels;
  if (staged.channels.empty()) return staged;
  StagedWriter file(stage, ChannelsName{});
  BlockWriter blocks(file, staged, source.info().positions);
  source.scan_channels([&](const ChannelPoints& batch) {
    blocks.add(batch);
    progress(blocks.points());
  });
  blocks.finish();
  staged.points = blocks.points();
  staged.file = file.commit();
  return staged;
}

std::vector<StagedPicture> stage_pictures(const MeshSource& source, const Stage& stage) {
  std::vector<StagedPicture> staged;
  const PictureFiles& pictures = source.info().pictures;
  for (std::size_t i = 0; i < pictures.names.size(); ++i) {
    const PictureName name{static_cast<std::uint32_t>(i)};
    staged.push_back({pictures.names[i], stage.publish(name, pictures.load(i))});
  }
  return staged;
}

PictureFiles pictures_of(const Stage& stage, std::vector<StagedPicture> pictures) {
  PictureFiles files;
  for (const StagedPicture& picture : pictures) files.names.push_back(picture.name);
  files.load = [&stage, staged = std::move(pictures)](std::size_t picture) {
    return stage.read(staged[picture].file);
  };
  return files;
}

ChannelReader::ChannelReader(Fill fill, const StagedChannels& staged, PositionType positions,
                             std::string what)
    : fill_(std::move(fill)), staged_(staged), positions_(positions), what_(std::move(what)) {}

bool ChannelReader::next(ChannelPoints& points) {
  if (done_ == staged_.points) return false;
  bytes_.resize(k_seal_head_bytes);
  fill_(bytes_);
  std::uint64_t value_bytes = 3 * static_cast<std::uint64_t>(positions_);
  for (const Channel& channel : staged_.channels) {
    value_bytes += static_cast<std::uint64_t>(channel.type);
  }
  const std::uint64_t payload = unseal_head(bytes_, k_channel_kind, k_channel_version, what_);
  if (payload > sizeof(std::uint32_t) + k_most_points * value_bytes) {
    throw DataError(what_ + ": a block of " + std::to_string(payload) + " bytes is impossible");
  }
  bytes_.resize(k_seal_head_bytes + payload + k_sum_bytes);
  fill_(std::span(bytes_).subspan(k_seal_head_bytes));
  ByteReader in(unseal(bytes_, k_channel_kind, k_channel_version, what_), what_);
  const auto count = in.get<std::uint32_t>();
  if (count == 0 || count > staged_.points - done_) in.fail("an impossible number of points");
  points.points = get_positions(in, count, positions_);
  points.values.resize(count * staged_.channels.size());
  for (std::size_t c = 0; c < staged_.channels.size(); ++c) {
    get_values(in, staged_.channels[c].type, points.values, c, staged_.channels.size());
  }
  in.expect_end();
  done_ += count;
  return true;
}

}  // namespace meshfarm
