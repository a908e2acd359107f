// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace meshfarm {

/// The member of "extras" of an accessor of linear colours: how many bits they have as sRGB, if
/// fewer than the accessor's.
inline constexpr const char* k_srgb_bits_extra = "srgbBits";

/// Parses a glTF document whose text begins at byte `start` of the file `path`. Throws DataError
/// for invalid JSON, and for arrays and objects nested deeper than in any glTF.
nlohmann::json parse_gltf_json(std::string_view text, std::uint64_t start, const std::string& path);

/// A value of a glTF document and its place: "m.glb: accessors[3].count". An invalid value is a
/// DataError that begins with the place. The document must outlive this.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& value, std::string place)
      : value_(&value), place_(std::move(place)) {}

  /// A member of this object.
  GltfValue at(std::string_view name) const;
  std::optional<GltfValue> find(std::string_view name) const;
  /// The size of this array; that of an absent member is 0.
  std::size_t size() const;
  std::size_t size_of(std::string_view name) const;
  GltfValue item(std::uint64_t index) const;

  double real() const;
  std::uint64_t whole() const;  // below 2^53
  std::uint64_t whole_or(std::string_view name, std::uint64_t otherwise) const;
  bool flag(std::string_view name) const;  // false if absent
  const std::string& text() const;
  const nlohmann::json& json() const { return *value_; }
  /// Without a trailing blank.
  std::string place() const;

  [[noreturn]] void fail(const std::string& why) const;

 private:
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace meshfarm
