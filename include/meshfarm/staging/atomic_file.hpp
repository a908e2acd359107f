// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A file that others see only whole: a temporary name in the same folder -> write -> fsync ->
/// close -> rename, each step checked (a full NFS disk shows only at fsync or close). Only commit()
/// publishes; the destructor removes what was not published.
class AtomicFile {
 public:
  enum class Readers { everyone, owner };

  /// Makes the temporary file. `unique` (process or incarnation) keeps two writers of one name
  /// apart.
  explicit AtomicFile(std::filesystem::path final_path, std::string_view unique = {},
                      Readers readers = Readers::everyone);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered; throws IoError.
  void write(std::string_view bytes);
  /// Replaces bytes that were written before; throws IoError.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// What was written is on the disk, or could not be: throws IoError. Nothing is published.
  void sync();
  std::uint64_t size() const { return flushed_ + buffer_.size(); }
  void commit();
  /// The same if nobody has the name yet; else false, and what is there stays. Of two writers one
  /// is told true (where a file system has no hard links that is not certain: look who has it).
  bool commit_new();

 private:
  void flush();
  void sync_and_close();
  bool link_final() const;

  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  Fd fd_;
  std::string buffer_;
  std::uint64_t flushed_ = 0;
};

/// Removes the temporary files of writers without a `unique` name that were killed while they wrote
/// this file. Nobody may be writing it. Errors are of no account.
void remove_unfinished(const std::filesystem::path& final_path);

/// Renames; where the answer is ENOENT although it was done (NFS server restart), looks at the
/// target before calling it a failure. Throws IoError.
void rename_checked(const std::filesystem::path& from, const std::filesystem::path& to,
                    std::uint64_t size_bytes);

}  // namespace meshfarm
