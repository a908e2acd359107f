// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <meshfarm/staging/names.hpp>
#include <meshfarm/staging/patience.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A staged file as named to others: the reader checks size and checksum.
struct FileRef {
  std::string name;  // relative to the stage, as made by staging/names.hpp
  std::uint64_t size = 0;
  std::uint64_t hash = 0;
  friend bool operator==(const FileRef&, const FileRef&) = default;
};

/// A part of a staged file that can be read on its own.
struct FileSection {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::uint64_t hash = 0;  // its checksum

  friend bool operator==(const FileSection&, const FileSection&) = default;
};
static_assert(std::is_trivially_copyable_v<FileSection> && sizeof(FileSection) == 24);

/// The shared folder of one dataset.
class Stage {
 public:
  /// Creates the folder and its sub-folders if missing. Throws IoError.
  static Stage create(const std::filesystem::path& root);
  /// An existing stage. Throws DataError if the folder holds no manifest, IoError if the storage
  /// gives no answer within the patience.
  static Stage open(const std::filesystem::path& root,
                    const ReadPatience& patience = {.attempts = 1});

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path path(const StagedName& name) const { return root_ / to_string(name); }
  bool has_manifest() const;

  /// Publishes the bytes under a name never used before, whole and synced. `unique` (an
  /// incarnation) keeps the temporary names of two writers apart.
  FileRef publish(const StagedName& name, std::string_view bytes,
                  std::string_view unique = {}) const;

  /// Publishes if nobody has published the name; otherwise returns false, and the existing file
  /// stays.
  bool publish_new(const StagedName& name, std::string_view bytes,
                   std::string_view unique = {}) const;

  /// Reads a file that a message named: its name must parse, it is opened beneath the stage only,
  /// and size and checksum must match; stale NFS answers are retried. Throws DataError, IoError.
  std::string read(const FileRef& file, const ReadPatience& patience = {}) const;
  /// Reads one section, checked by its own checksum.
  std::string read(const FileRef& file, const FileSection& section,
                   const ReadPatience& patience = {}) const;
  /// Checks the whole file in bounded memory, without returning its content.
  void verify(const FileRef& file, const ReadPatience& patience = {}) const;
  /// Opens such a file for a reader that checks its bytes while reading; checks the size here.
  Fd open_told(const FileRef& file, const ReadPatience& patience = {}) const;
  /// Reads a file known by name only; its seal is the check. Throws IoError.
  std::string read(const StagedName& name, const ReadPatience& patience = {.attempts = 1}) const;

  /// The numbers of the existing journals or endpoints, ascending. Lists the folder, which also
  /// makes an NFS client look again.
  std::vector<std::uint32_t> journals() const;
  std::vector<std::uint32_t> epochs() const;
  /// The numbers of traces and summaries; empty for a stage from before they existed.
  std::vector<std::uint32_t> traces() const;
  std::vector<std::uint32_t> summaries() const;
  /// The boots of the hosts that published their cards, ascending.
  std::vector<std::uint64_t> hosts() const;

  void remove(const StagedName& name) const noexcept;

 private:
  explicit Stage(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path root_;
};

/// Removes a stage's files, and its folder if nothing else is in it.
void remove_stage(const std::filesystem::path& root);

}  // namespace meshfarm
