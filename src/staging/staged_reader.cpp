// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include <meshfarm/staging/staged_reader.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

StagedReader::StagedReader(const Stage& stage, const FileRef& file)
    : file_(file), path_(stage.root() / file.name), fd_(stage.open_told(file)) {}

void StagedReader::fill(std::span<char> buffer) {
  std::size_t got = 0;
  try {
    got = read_up_to(fd_.get(), buffer, path_);
  } catch (const IoError& error) {
    throw UnreadIoError(error);
  }
  if (got < buffer.size()) {
    throw UnreadDataError(path_.string() + ": cut short at byte " + std::to_string(done_ + got));
  }
  sum_.add({buffer.data(), buffer.size()});
  done_ += buffer.size();
}

void StagedReader::expect_end() const {
  if (done_ != file_.size) {
    throw UnreadDataError(path_.string() + ": " + std::to_string(file_.size - done_) +
                          " bytes too many at byte " + std::to_string(done_));
  }
  if (sum_.value() != file_.hash) {
    throw UnreadDataError(path_.string() + ": damaged (its checksum is not the promised one)");
  }
}

}  // namespace meshfarm
