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

/// The mount that contains a path, from /proc/self/mountinfo.
struct Mount {
  std::string point;
  std::string type;                  // "nfs4"
  std::string source;                // "server:/export"
  std::vector<std::string> options;  // of the mount and of its file system: "rw", "vers=4.2"

  bool has(std::string_view option) const;
  /// The value of an option: "4.2" for "vers=4.2".
  std::optional<std::string> value(std::string_view option) const;
  bool is_nfs() const { return type == "nfs" || type == "nfs4"; }
};

/// The mount of an absolute path without links, given the text of a mountinfo file (proc(5)).
std::optional<Mount> find_mount(std::string_view mountinfo, const std::filesystem::path& path);
/// Throws IoError if the path does not exist; returns a mount without a type if the system does not
/// tell.
Mount mount_of(const std::filesystem::path& path);

/// Free bytes for an ordinary user. Throws IoError.
std::uint64_t free_bytes(const std::filesystem::path& path);

/// Writes and syncs this many bytes and removes them again. Throws IoError if there is no room:
/// free_bytes() does not account for quotas.
void probe_room(const std::filesystem::path& folder, std::uint64_t bytes);

/// The folder for scratch files of this size: `wanted`; if that is empty, $TMPDIR if it is set and
/// has room, else `otherwise`. Throws DataError if there is no room, IoError.
std::filesystem::path scratch_folder(const std::filesystem::path& wanted,
                                     const std::filesystem::path& otherwise, std::uint64_t bytes);

/// The time by the folder's server, from a file that is created and removed; nothing if none can be
/// created.
std::optional<std::filesystem::file_time_type> server_clock(const std::filesystem::path& folder);
/// The server's clock as a time_t with a fraction.
std::optional<double> server_unix_s(const std::filesystem::path& folder);
/// The server's clock, or this host's if no file can be created.
std::filesystem::file_time_type clock_of(const std::filesystem::path& folder);

/// Whether a file created for its owner alone stays private. Throws IoError.
bool keeps_private(const std::filesystem::path& folder);

/// Milliseconds taken by each step of publishing one file.
struct RoundTrip {
  double write = 0;
  double sync = 0;
  double rename = 0;
  double read = 0;
};

/// The measured behaviour of a folder's file system.
struct FolderProbe {
  std::vector<RoundTrip> trips;
  double clock_ahead_s = 0;    // the server's clock minus ours, from a file's time
  bool keeps_private = false;  // a file that only its owner can read stays so
  bool has_links = false;
  std::string problem;  // the first problem; empty: none
};

/// Publishes `count` files of `size_bytes` as workers do, reads them back and removes them.
FolderProbe probe_folder(const std::filesystem::path& folder, int count, std::size_t size_bytes);

}  // namespace meshfarm
