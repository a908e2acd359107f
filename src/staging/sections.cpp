// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

FileSection SectionWriter::add(std::string_view bytes) {
  const FileSection section{written_, bytes.size(), checksum(bytes)};
  write_(bytes);
  written_ += bytes.size();
  return section;
}

SectionedFile::SectionedFile(const Stage& stage, const FileRef& file)
    : path_(stage.root() / file.name), size_(file.size), fd_(stage.open_told(file)) {}

std::string SectionedFile::read(const FileSection& section) const {
  if (section.offset > size_ || section.size > size_ - section.offset) {
    throw UnreadDataError(path_.string() + ": has no section at byte " +
                          std::to_string(section.offset));
  }
  std::string bytes(section.size, '\0');
  std::size_t got = 0;
  try {
    got = read_at(fd_.get(), section.offset, bytes, path_);
  } catch (const IoError& error) {
    throw UnreadIoError(error);
  }
  if (got < bytes.size() || checksum(bytes) != section.hash) {
    throw UnreadDataError(path_.string() + ": damaged, or cut short, at byte " +
                          std::to_string(section.offset));
  }
  return bytes;
}

}  // namespace meshfarm
