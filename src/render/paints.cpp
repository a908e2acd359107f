// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/paints.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/text.hpp>

namespace meshfarm {
namespace {

[[noreturn]] void fail(const MeshFileInfo& info, const std::string& name, const std::string& what) {
  std::vector<std::string> names;
  for (const Channel& channel : info.channels) names.push_back(channel.name);
  throw DataError(
      name + ": has no " + what + " to be coloured by; " +
      (names.empty() ? "its vertices have positions only" : "its vertices have " + joined(names)));
}

bool have_colours(const LabelMeaning& labels) {
  const auto is_coloured = [](const Material& m) {
    return m.colour[0] != 1 || m.colour[1] != 1 || m.colour[2] != 1;
  };
  return std::any_of(labels.materials.begin(), labels.materials.end(), is_coloured);
}

}  // namespace

Paints::Paints(const MeshFileInfo& info, const RenderOptions& options)
    : mesh_(options.name), up_(options.view.up), channels_(info.channels.size()) {
  choose(info, options);
  if (have_scale() && options.range) {
    range_ = {(*options.range)[0], (*options.range)[1]};
    is_range_given_ = true;
  }
}

void Paints::choose(const MeshFileInfo& info, const RenderOptions& options) {
  switch (options.colour_by) {
    case ColourBy::none:
      return;
    case ColourBy::normal:
      from_ = From::normals;
      name_ = "normal";
      return;
    case ColourBy::piece:
      from_ = From::pieces;
      name_ = "piece";
      return;
    case ColourBy::part:
      throw DataError(options.name + ": is no stage, and has no parts to be coloured by");
    case ColourBy::height:
      from_ = From::heights;
      name_ = "height";
      return;
    case ColourBy::label:
      if (!info.labels) fail(info, options.name, "labels of triangles");
      from_ = From::labels;
      name_ = info.labels->name;
      return;
    case ColourBy::automatic:
    case ColourBy::colour:
      choose_colours(info);
      if (from_ == From::nothing && options.colour_by == ColourBy::colour)
        fail(info, options.name, "colours");
      return;
    case ColourBy::quality:
    case ColourBy::channel:
      return choose_channel(info, options);
  }
}

void Paints::choose_colours(const MeshFileInfo& info) {
  if (const auto columns = colour_columns(info.channels)) {
    from_ = From::colours;
    name_ = "colour";
    columns_ = *columns;
    for (std::size_t i = 0; i < 3; ++i) types_[i] = info.channels[columns_[i]].type;
  } else if (info.labels && have_colours(*info.labels)) {
    from_ = From::materials;
    name_ = "material";
    for (const Material& m : info.labels->materials) {
      materials_.push_back({m.colour[0], m.colour[1], m.colour[2]});
    }
  }
}

void Paints::choose_channel(const MeshFileInfo& info, const RenderOptions& options) {
  const bool is_named = options.colour_by == ColourBy::channel;
  const auto found =
      std::find_if(info.channels.begin(), info.channels.end(), [&](const Channel& channel) {
        return is_named ? channel.name == options.channel : channel.role == ChannelRole::quality;
      });
  if (found == info.channels.end()) {
    fail(info, options.name, is_named ? "channel '" + options.channel + "'" : "number of its own");
  }
  from_ = From::values;
  name_ = found->name;
  columns_[0] = static_cast<std::size_t>(found - info.channels.begin());
}

float Paints::value_of(Vec3 vertex, std::span<const float> values) const {
  return from_ == From::heights ? static_cast<float>(dot(up_, vertex)) : values[columns_[0]];
}

std::uint32_t Paints::of(Vec3 vertex, std::span<const float> values) const {
  if (have_scale()) return std::bit_cast<std::uint32_t>(value_of(vertex, values));
  Srgb colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float level = 255 * colour_level(types_[i], values[columns_[i]]);
    if (level > 0) colour[i] = static_cast<std::uint8_t>(std::lround(std::min(level, 255.0F)));
  }
  return packed(colour);
}

void Paints::look_at(std::span<const Vec3> points, std::span<const float> values) {
  if (is_range_given_) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::span<const float> of_vertex =
        values.empty() ? values : values.subspan(i * channels_, channels_);
    const auto value = static_cast<double>(value_of(points[i], of_vertex));
    if (!std::isfinite(value)) continue;
    range_.low = std::min(range_.low, value);
    range_.high = std::max(range_.high, value);
  }
}

void Paints::finish_range() {
  if (have_scale() && !(range_.low <= range_.high)) {
    throw DataError(mesh_ + ": no vertex has a finite " + name_ + " to be coloured by");
  }
}

CornerColours Paints::of_triangle(Label label, const std::array<std::uint32_t, 3>& corners) const {
  using Kind = CornerColours::Kind;
  CornerColours made;
  switch (from_) {
    case From::nothing:
      made.lights[0] = light_of(k_clay);
      break;
    case From::normals:
      made.kind = Kind::normal;
      break;
    case From::labels:
      made.lights[0] = light_of(colour_of_number(label));
      break;
    case From::materials:
      made.lights[0] = label < materials_.size() ? materials_[label] : light_of(k_clay);
      break;
    case From::pieces:
      made.lights[0] = light_of(unpacked(corners[0]));
      break;
    case From::colours:
      made.kind = Kind::each;
      for (std::size_t i = 0; i < 3; ++i) made.lights[i] = light_of(unpacked(corners[i]));
      break;
    case From::values:
    case From::heights:
      made.kind = Kind::values;
      made.range = range_;
      for (std::size_t i = 0; i < 3; ++i) made.values[i] = std::bit_cast<float>(corners[i]);
      break;
  }
  return made;
}

}  // namespace meshfarm
