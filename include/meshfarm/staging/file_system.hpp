// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshfarm {

/// The mount that a path is on, as /proc/self/mountinfo tells.
struct Mount {
  std::string point;
  std::string type;                  // "nfs4"
  std::string source;                // "server:/export"
  std::vector<std::string> options;  // of the mount and of its file system: "rw", "vers=4.2"

  bool has(std::string_view option) const;
  /// Of "vers=4.2": "4.2".
  std::optional<std::string> value(std::string_view option) const;
  bool is_nfs() const { return type == "nfs" || type == "nfs4"; }
};

/// The mount that an absolute path without links is on, by the text of a mountinfo file (proc(5)).
std::optional<Mount> find_mount(std::string_view mountinfo, const std::filesystem::path& path);
/// Throws IoError if the path is not there; a mount without a type if the system does not tell.
Mount mount_of(const std::filesystem::path& path);

/// Free bytes for an ordinary user. Throws IoError.
std::uint64_t free_bytes(const std::filesystem::path& path);

/// Writes and syncs so many bytes and removes them again. Throws IoError if there is no room: for
/// who has a share of the disk, free_bytes() does not tell.
void probe_room(const std::filesystem::path& folder, std::uint64_t bytes);

/// Where scratch files of so many bytes go: to `wanted`; if that is empty to $TMPDIR, where that is
/// set and has room, else to `otherwise`. Throws DataError if there is no room, IoError.
std::filesystem::path scratch_folder(const std::filesystem::path& wanted,
                                     const std::filesystem::path& otherwise, std::uint64_t bytes);

/// The time as the folder's server tells it, by a file that is made and removed; nothing where none
/// can be made.
std::optional<std::filesystem::file_time_type> server_clock(const std::filesystem::path& folder);
/// The same as a time_t with a fraction.
std::optional<double> server_unix_s(const std::filesystem::path& folder);
/// The server's clock; where no file can be made, this host's.
std::filesystem::file_time_type clock_of(const std::filesystem::path& folder);

/// Whether a file that is made for its owner alone stays so. Throws IoError.
bool keeps_private(const std::filesystem::path& folder);

/// Milliseconds that each step of publishing one file took.
struct RoundTrip {
  double write = 0;
  double sync = 0;
  double rename = 0;
  double read = 0;
};

/// What a folder's file system was seen to do.
struct FolderProbe {
  std::vector<RoundTrip> trips;
  double clock_ahead_s = 0;    // the server's clock, by a file's time, against ours
  bool keeps_private = false;  // a file that is the owner's alone stays so
  bool has_links = false;
  std::string problem;  // what went wrong first; empty: nothing
};

/// Publishes `count` files of `size_bytes` as workers do, reads them back and removes them.
FolderProbe probe_folder(const std::filesystem::path& folder, int count, std::size_t size_bytes);

}  // namespace meshfarm
