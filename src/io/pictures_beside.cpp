// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pictures_beside.hpp"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "file_sink.hpp"
#include "files_beside.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_most_open = 256;

/// One word that is valid in every format and names a file in the folder itself.
std::string file_word_of(std::string name) {
  for (char& c : name) {
    const bool is_odd = static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '#' ||
                        c == '\\' || c == '/' || c == '"';
    if (is_odd) c = '_';
  }
  return name;
}

/// "C:\maps\atlas.jpg" and "maps/atlas.jpg" are "atlas.jpg".
std::string last_part(const std::string& name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

bool holds(const std::filesystem::path& path, const std::string& bytes) {
  std::error_code error;
  if (std::filesystem::file_size(path, error) != bytes.size() || error) return false;
  try {
    return read_beside(path) == bytes;
  } catch (const std::exception&) {  // it is replaced then, or replacing it fails
    return false;
  }
}

}  // namespace

PicturesBeside::PicturesBeside(const std::filesystem::path& mesh, PictureFiles pictures)
    : folder_(mesh.parent_path()),
      before_(file_word_of(mesh.stem().string()) + "_"),
      pictures_(std::move(pictures)) {}

const std::string& PicturesBeside::name_of(std::size_t picture) {
  const auto found = names_.find(picture);
  if (found != names_.end()) return found->second;
  return names_.emplace(picture, free_name(picture)).first->second;
}

/// A picture whose name already begins with the mesh's keeps its name.
std::string PicturesBeside::free_name(std::size_t picture) {
  const std::filesystem::path wanted = file_word_of(last_part(pictures_.names.at(picture)));
  std::string stem = wanted.stem().string();
  if (!stem.starts_with(before_)) stem.insert(0, before_);
  const std::string extension = wanted.extension().string();
  std::string name = stem + extension;
  for (std::size_t number = 2; is_of_another(name, picture) || !taken_.insert(name).second;) {
    name = stem;
    name.append("_").append(std::to_string(number++)).append(extension);
  }
  return name;
}

bool PicturesBeside::is_of_another(const std::string& name, std::size_t picture) const {
  if (last_part(pictures_.names[picture]) == name) return false;
  return std::any_of(pictures_.names.begin(), pictures_.names.end(),
                     [&](const std::string& other) { return last_part(other) == name; });
}

std::unique_ptr<AtomicFile> PicturesBeside::copy_of(std::size_t picture,
                                                    const std::string& name) const {
  const std::string bytes = pictures_.load(picture);
  const std::filesystem::path path = folder_ / name;
  if (holds(path, bytes)) return nullptr;
  auto file = std::make_unique<AtomicFile>(checked_output(path));
  file->write(bytes);
  file->sync();
  return file;
}

void PicturesBeside::finish() {
  for (const auto& [picture, name] : names_) {
    if (files_.size() == k_most_open) return;
    files_.push_back(copy_of(picture, name));
  }
}

void PicturesBeside::commit() {
  for (const auto& file : files_) {
    if (file) file->commit();
  }
  const std::size_t done = files_.size();
  for (auto each = std::next(names_.begin(), static_cast<std::ptrdiff_t>(done));
       each != names_.end(); ++each) {
    if (const auto file = copy_of(each->first, each->second)) file->commit();
  }
  files_.clear();
}

}  // namespace meshfarm
