// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/text.hpp>

namespace meshfarm {
namespace {

/// The name that stands for texture coordinates.
constexpr std::string_view k_word_uvs = "uvs";

/// Whether the user's name means this channel.
bool means(std::string_view name, const Channel& channel) {
  if (name == channel.name) return true;
  return (name == "colours" && channel.role == ChannelRole::colour) ||
         (name == "normals" && channel.role == ChannelRole::normal);
}

std::string names_of(std::span<const Channel> channels, const std::optional<LabelMeaning>& labels) {
  std::vector<std::string> names;
  if (labels) names.push_back(labels->name);
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names.empty() ? "none" : joined(names);
}

class ChosenChannels : public MeshSource {
 public:
  ChosenChannels(std::unique_ptr<MeshSource> source, const ChannelChoice& choice)
      : source_(std::move(source)),
        columns_(chosen_columns(choice, source_->info().channels, source_->info().labels)),
        info_(source_->info()) {
    if (info_.uvs && !chooses_uvs(choice)) {
      info_.uvs = false;
      info_.pictures = {};
      info_.skipped.emplace_back("texture coordinates");
    }
    // Pictures need the materials that name them.
    if (info_.labels && !chooses_labels(choice, *info_.labels) && info_.pictures.names.empty()) {
      info_.skipped.push_back(std::exchange(info_.labels, {})->name);
    }
    const std::vector<Channel> all = std::exchange(info_.channels, {});
    info_.channels = channels_at(all, columns_);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!std::binary_search(columns_.begin(), columns_.end(), i)) {
        info_.skipped.push_back(all[i].name);
      }
    }
  }

  const MeshFileInfo& info() const override {
    info_.positions = source_->info().positions;  // may be changed by a scan
    return info_;
  }
  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    source_->scan_vertices(take);
  }
  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    const ColumnSet columns = info_.columns();
    if (columns == source_->info().columns()) return source_->scan_triangles(take);
    source_->scan_triangles([&](const TriangleView& batch) {
      TriangleColumnsView kept;
      if (columns.labels) kept.labels = batch.columns.labels;
      if (columns.uvs) kept.uvs = batch.columns.uvs;
      take({batch.corners, kept});
    });
  }
  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    if (columns_.empty()) return;
    const std::size_t width = source_->info().channels.size();
    source_->scan_channels([&](const ChannelPoints& batch) {
      take({batch.points, values_at(batch.values, width, columns_)});
    });
  }
  std::uint64_t small_faces() const override { return source_->small_faces(); }

 private:
  std::unique_ptr<MeshSource> source_;
  std::vector<std::size_t> columns_;
  mutable MeshFileInfo info_;
};

}  // namespace

ChannelChoice parse_choice(std::string_view text, std::string_view option) {
  if (text == "auto") return {};
  ChannelChoice choice{.all = false, .names = {}};
  if (text == "none") return choice;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view name = text.substr(0, comma);
    if (name.empty()) {
      throw UsageError(std::string(option) +
                       " is 'auto', 'none' or names of channels with commas between them");
    }
    choice.names.emplace_back(name);
    if (comma == std::string_view::npos) return choice;
    text.remove_prefix(comma + 1);
  }
}

bool chooses_uvs(const ChannelChoice& choice) {
  return choice.all ||
         std::find(choice.names.begin(), choice.names.end(), k_word_uvs) != choice.names.end();
}

bool chooses_labels(const ChannelChoice& choice, const LabelMeaning& labels) {
  return choice.all ||
         std::find(choice.names.begin(), choice.names.end(), labels.name) != choice.names.end();
}

std::vector<std::size_t> chosen_columns(const ChannelChoice& choice,
                                        std::span<const Channel> channels,
                                        const std::optional<LabelMeaning>& labels) {
  for (const std::string& name : choice.names) {
    if (name == k_word_uvs || (labels && name == labels->name)) continue;
    if (std::none_of(channels.begin(), channels.end(),
                     [&](const Channel& channel) { return means(name, channel); })) {
      throw UsageError("--attributes: there is no channel '" + name +
                       "'; there are: " + names_of(channels, labels));
    }
  }
  std::vector<std::size_t> columns;
  std::size_t normals = 0;
  std::size_t chosen_normals = 0;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const bool is_chosen = choice.all || std::any_of(choice.names.begin(), choice.names.end(),
                                                     [&](const std::string& name) {
                                                       return means(name, channels[i]);
                                                     });
    if (is_chosen) columns.push_back(i);
    if (channels[i].role != ChannelRole::normal) continue;
    ++normals;
    chosen_normals += is_chosen ? 1 : 0;
  }
  if (chosen_normals != 0 && chosen_normals != normals) {
    throw UsageError("--attributes: nx, ny and nz go together, or 'normals' for the three");
  }
  return columns;
}

std::vector<Channel> channels_at(std::span<const Channel> channels,
                                 std::span<const std::size_t> columns) {
  std::vector<Channel> made;
  for (const std::size_t column : columns) made.push_back(channels[column]);
  return made;
}

std::vector<float> values_at(std::span<const float> values, std::size_t width,
                             std::span<const std::size_t> columns) {
  std::vector<float> made;
  made.reserve(values.size() / std::max<std::size_t>(1, width) * columns.size());
  for (std::size_t first = 0; first < values.size(); first += width) {
    for (const std::size_t column : columns) made.push_back(values[first + column]);
  }
  return made;
}

std::unique_ptr<MeshSource> with_channels(std::unique_ptr<MeshSource> source,
                                          const ChannelChoice& choice) {
  if (choice.all) return source;
  return std::make_unique<ChosenChannels>(std::move(source), choice);
}

}  // namespace meshfarm
