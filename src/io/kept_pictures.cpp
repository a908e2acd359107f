// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "kept_pictures.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "files_beside.hpp"
#include "picture.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_longest_stem = 120;

std::string small_letters(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return text;
}

bool is_extension_of(PictureHead::Kind kind, std::string_view extension) {
  if (kind == PictureHead::Kind::png) return extension == ".png";
  return extension == ".jpg" || extension == ".jpeg" || extension == ".jpe";
}

/// Whether it is a picture's extension; here it is one that does not fit the content.
bool is_other_extension(std::string_view extension) {
  static constexpr std::array<std::string_view, 13> k_known{
      ".png", ".jpg",  ".jpeg", ".jpe", ".webp", ".bmp", ".tga",
      ".tif", ".tiff", ".gif",  ".dds", ".ktx",  ".ktx2"};
  return std::find(k_known.begin(), k_known.end(), extension) != k_known.end();
}

/// A name that is valid on every system, without characters that have a meaning in some format.
std::string cleaned(std::string_view stem) {
  constexpr std::string_view k_odd = "<>:\"|?*#%";
  std::string made(stem.substr(0, k_longest_stem));
  if (made.size() < stem.size()) {  // does not split a character
    while (!made.empty() && (static_cast<unsigned char>(stem[made.size()]) & 0xc0) == 0x80) {
      made.pop_back();
    }
  }
  for (char& c : made) {
    const auto code = static_cast<unsigned char>(c);
    if (code < ' ' || code == 0x7f || k_odd.find(c) != std::string_view::npos) c = '_';
  }
  if (made.empty()) return "image";
  if (made.front() == '-' || made.front() == '.' || made.front() == ' ') made.front() = '_';
  if (made.back() == ' ' || made.back() == '.') made.back() = '_';
  return made;
}

}  // namespace

TextureImage picture_beside(const std::filesystem::path& folder, const std::string& name) {
  return {name, [folder, name] {
            const std::optional<std::filesystem::path> found = find_beside(folder, name);
            if (!found) throw DataError("no such file beside the mesh, or in a folder below");
            return read_beside(*found);
          }};
}

std::optional<std::uint32_t> KeptPictures::number_of(const std::string& key,
                                                     std::string_view wanted,
                                                     const TextureImage& image) {
  const auto [known, is_new] = known_.try_emplace(key);
  if (!is_new) return known->second;
  // A mesh is useful without its pictures, and many come without them.
  try {
    std::string name = free_name(wanted, image.load());
    known->second = static_cast<std::uint32_t>(names_.size());
    names_.push_back(std::move(name));
    loads_.push_back(image.load);
  } catch (const Error& error) {
    warn_(path_ + ": the texture " + image.name + ": " + error.what() + "; it is left out");
  }
  return known->second;
}

std::string KeptPictures::free_name(std::string_view wanted, std::string_view bytes) {
  const PictureHead::Kind kind = read_picture_head(bytes).kind;
  wanted.remove_prefix(wanted.find_last_of("/\\") + 1);  // npos + 1 is 0
  const std::size_t dot = std::min(wanted.rfind('.'), wanted.size());
  std::string extension(wanted.substr(dot));
  const std::string small = small_letters(extension);
  if (!is_extension_of(kind, small)) {
    if (!is_other_extension(small)) extension.clear();
    wanted.remove_suffix(extension.size());
    extension = kind == PictureHead::Kind::png ? ".png" : ".jpg";
  } else {
    wanted.remove_suffix(extension.size());
  }
  const std::string stem = cleaned(wanted);
  std::string made = stem + extension;
  unsigned& number = number_.try_emplace(small_letters(made), 1).first->second;
  while (!taken_.insert(small_letters(made)).second) {
    made = stem;
    made.append("_").append(std::to_string(++number)).append(extension);
  }
  return made;
}

PictureFiles KeptPictures::files() && {
  const auto loads =
      std::make_shared<const std::vector<std::function<std::string()>>>(std::move(loads_));
  return {std::move(names_), [loads](std::size_t picture) { return loads->at(picture)(); }};
}

}  // namespace meshfarm
