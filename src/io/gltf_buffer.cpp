// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_buffer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

GltfBuffer buffer_in_memory(std::string bytes) {
  const auto held = std::make_shared<const std::string>(std::move(bytes));
  return {held->size(), [held](std::uint64_t offset, std::span<char> out) {
            if (!out.empty()) std::memcpy(out.data(), held->data() + offset, out.size());
          }};
}

GltfBuffer buffer_in_scratch(std::shared_ptr<const ScratchFile> scratch, std::uint64_t start,
                             std::uint64_t size) {
  return {size, [held = std::move(scratch), start](std::uint64_t offset, std::span<char> out) {
            if (read_at(held->fd.get(), start + offset, out, held->folder) == out.size()) return;
            throw IoError("cannot read a scratch file in", held->folder, EIO);
          }};
}

GltfBuffer GltfStore::keep(std::string bytes) {
  constexpr std::uint64_t k_most_in_memory = std::uint64_t{16} << 20;
  if (bytes.size() <= k_most_in_memory - in_memory_) {
    in_memory_ += bytes.size();
    return buffer_in_memory(std::move(bytes));
  }
  if (!scratch_) scratch_ = std::make_shared<const ScratchFile>(make_scratch_file());
  write_all(scratch_->fd.get(), bytes, scratch_->folder);
  const std::uint64_t start = std::exchange(in_scratch_, in_scratch_ + bytes.size());
  return buffer_in_scratch(scratch_, start, bytes.size());
}

std::shared_ptr<const InputFile> GltfFiles::open(const std::filesystem::path& path) {
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const auto& file) { return file->path() == path; });
  if (found != open_.end()) {
    std::rotate(found, found + 1, open_.end());
    return open_.back();
  }
  if (open_.size() == k_most_open) open_.erase(open_.begin());
  open_.push_back(std::make_shared<const InputFile>(path));
  return open_.back();
}

GltfBuffer buffer_in_file(const std::shared_ptr<GltfFiles>& files,
                          const std::filesystem::path& path) {
  const std::uint64_t size = files->open(path)->size();
  return {size, [files, path, size](std::uint64_t offset, std::span<char> out) {
            const std::shared_ptr<const InputFile> file = files->open(path);
            if (file->size() != size) {
              throw DataError(path.string() + ": changed while it was read: of " +
                              std::to_string(size) + " bytes it has " +
                              std::to_string(file->size()));
            }
            file->read(offset, out);
          }};
}

}  // namespace meshfarm
