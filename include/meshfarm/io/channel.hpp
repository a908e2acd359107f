// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// What the values of a channel are for.
enum class ChannelRole : std::uint8_t { colour, normal, quality };

/// How a channel's values are stored; the number is the size in bytes. In computations all are
/// floats.
enum class ChannelType : std::uint8_t { uint8 = 1, uint16 = 2, float32 = 4 };

/// A number per vertex beside the position, which is interpolated over the surface: a component of
/// a colour or of a normal, a confidence, an intensity.
struct Channel {
  std::string name;  // as in the file: "red"
  ChannelType type = ChannelType::float32;
  ChannelRole role = ChannelRole::quality;

  bool operator==(const Channel&) const = default;
};

/// Points and their values: all channels of the first point, then those of the next.
struct ChannelPoints {
  std::vector<Vec3> points;
  std::vector<float> values;
};

/// The indices of red, green and blue among the channels; nothing unless all three are there.
std::optional<std::array<std::size_t, 3>> colour_columns(std::span<const Channel> channels);

/// The same for nx, ny and nz.
std::optional<std::array<std::size_t, 3>> normal_columns(std::span<const Channel> channels);

/// The index of the colour's alpha; nothing without a colour.
std::optional<std::size_t> alpha_column(std::span<const Channel> channels);

/// A component of a colour as 0 to 1: whole numbers are divided by their type's largest, floats
/// stay.
float colour_level(ChannelType type, float value);

/// Makes appearances of channel values: of the first four that are components of a colour. Other
/// numbers have no known range, and normals follow from the shape.
class AppearanceColumns {
 public:
  explicit AppearanceColumns(std::span<const Channel> channels);
  bool empty() const { return columns_.empty(); }
  /// `values`: all channels of one vertex.
  Appearance of(std::span<const float> values) const;

 private:
  struct Column {
    std::size_t channel = 0;
    ChannelType type = ChannelType::uint8;
  };
  std::vector<Column> columns_;
};

/// The nearest value that the type can hold.
float rounded_to(ChannelType type, float value);

/// Makes interpolated values valid again: values that their types can hold, normals of length 1.
/// Values that are not finite become 0.
void repair_values(std::span<const Channel> channels, std::span<float> values);

}  // namespace meshfarm
