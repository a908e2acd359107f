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
/// publishes; the destructor removes a file that was not published.
class AtomicFile {
 public:
  enum class Readers { everyone, owner };

  /// Creates the temporary file. `unique` (process or incarnation) keeps two writers of the same
  /// name apart.
  explicit AtomicFile(std::filesystem::path final_path, std::string_view unique = {},
                      Readers readers = Readers::everyone);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered; throws IoError.
  void write(std::string_view bytes);
  /// Replaces bytes that were already written; throws IoError.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// Ensures that everything written is on disk. Publishes nothing. Throws IoError.
  void sync();
  std::uint64_t size() const { return flushed_ + buffer_.size(); }
  void commit();
  /// Commits if nobody has the name yet; otherwise returns false, and the existing file stays. Of
  /// two writers only one gets true (on file systems without hard links that is not certain: check
  /// whose file it is).
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

/// Removes the temporary files of writers without a `unique` name that were killed while writing
/// this file. Nobody may be writing it. Errors are ignored.
void remove_unfinished(const std::filesystem::path& final_path);

/// Renames; if the answer is ENOENT although the rename was done (NFS server restart), checks the
/// target before treating it as a failure. Throws IoError.
void rename_checked(const std::filesystem::path& from, const std::filesystem::path& to,
                    std::uint64_t size_bytes);

}  // namespace meshfarm
