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

/// What "extras" of an accessor of linear colours have: how many bits they have as sRGB, if these
/// are fewer than the accessor's.
inline constexpr const char* k_srgb_bits_extra = "srgbBits";

/// Parses a glTF document, the text of which begins at byte `start` of the file `path`. Throws
/// DataError for what is no JSON, and for arrays and objects in each other deeper than any glTF.
nlohmann::json parse_gltf_json(std::string_view text, std::uint64_t start, const std::string& path);

/// A value of a glTF document and where it stands: "m.glb: accessors[3].count". What is not as it
/// must be is a DataError that begins with the place. The document must outlive this.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& value, std::string place)
      : value_(&value), place_(std::move(place)) {}

  /// A member of this object.
  GltfValue at(std::string_view name) const;
  std::optional<GltfValue> find(std::string_view name) const;
  /// Of this array; a member that is absent has none.
  std::size_t size() const;
  std::size_t size_of(std::string_view name) const;
  GltfValue item(std::uint64_t index) const;

  double real() const;
  std::uint64_t whole() const;  // below 2^53
  std::uint64_t whole_or(std::string_view name, std::uint64_t otherwise) const;
  bool flag(std::string_view name) const;  // false if absent
  const std::string& text() const;
  const nlohmann::json& json() const { return *value_; }
  /// Without a blank at its end.
  std::string place() const;

  [[noreturn]] void fail(const std::string& why) const;

 private:
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace meshfarm
