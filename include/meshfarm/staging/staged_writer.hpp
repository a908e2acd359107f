// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {

/// Writes a staged file front to back, in pieces, when it does not fit into memory. Others see it
/// after commit(), whole and synced; without commit() it is removed.
class StagedWriter {
 public:
  /// `unique` (an incarnation) keeps the temporary names of two writers apart.
  StagedWriter(const Stage& stage, const StagedName& name, std::string_view unique = {})
      : name_(to_string(name)), file_(stage.path(name), unique) {}
  /// Buffered; throws IoError.
  void write(std::string_view bytes) {
    file_.write(bytes);
    sum_.add(bytes);
  }
  /// Of the bytes written so far.
  std::uint64_t hash() const { return sum_.value(); }
  FileRef commit() {
    file_.commit();
    return {name_, file_.size(), sum_.value()};
  }
  /// Commits if nobody has the name yet; else returns false (AtomicFile::commit_new).
  bool commit_new() { return file_.commit_new(); }

 private:
  std::string name_;
  AtomicFile file_;
  Checksum sum_;
};

}  // namespace meshfarm
