// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/labels.hpp>

#include "texture_colours.hpp"

namespace meshfarm {

/// The picture with this name in this folder or below it.
TextureImage picture_beside(const std::filesystem::path& folder, const std::string& name);

/// Collects the pictures of materials, to pass them on as whole files. Each gets a unique file
/// name, regardless of the case of letters, with an extension that fits its content.
class KeptPictures {
 public:
  using Warn = std::function<void(const std::string& line)>;
  KeptPictures(std::string path, Warn warn) : path_(std::move(path)), warn_(std::move(warn)) {}

  /// The number of a picture; `key` identifies it. Nothing, after a warning, if it is missing or
  /// cannot be read. `wanted` is its name, which may have folders or no extension.
  std::optional<std::uint32_t> number_of(const std::string& key, std::string_view wanted,
                                         const TextureImage& image);
  /// What image.load needs must live as long as this.
  PictureFiles files() &&;

 private:
  std::string free_name(std::string_view wanted, std::string_view bytes);

  std::string path_;
  Warn warn_;
  std::map<std::string, std::optional<std::uint32_t>> known_;
  std::vector<std::string> names_;
  std::vector<std::function<std::string()>> loads_;
  std::set<std::string> taken_;             // names in small letters
  std::map<std::string, unsigned> number_;  // the last suffix given to each name
};

}  // namespace meshfarm
