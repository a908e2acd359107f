// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include <sys/statvfs.h>
#include <unistd.h>

#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

void add_options(Mount& mount, const std::string& list) {
  std::istringstream words(list);
  for (std::string option; std::getline(words, option, ',');) {
    if (!mount.has(option)) mount.options.push_back(option);
  }
}

/// Decodes mountinfo's octal escapes for blanks.
std::string unescaped(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '\\' && i + 3 < text.size() &&
        std::from_chars(digits, digits + 3, code, 8).ptr == digits + 3) {
      plain += static_cast<char>(code);
      i += 3;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

bool is_within(const std::string& path, const std::string& folder) {
  if (!path.starts_with(folder)) return false;
  return folder == "/" || path.size() == folder.size() || path[folder.size()] == '/';
}

}  // namespace

bool Mount::has(std::string_view option) const {
  return std::find(options.begin(), options.end(), option) != options.end();
}

std::optional<std::string> Mount::value(std::string_view option) const {
  const std::string start = std::string(option) + "=";
  for (const std::string& each : options) {
    if (each.starts_with(start)) return each.substr(start.size());
  }
  return std::nullopt;
}

std::optional<Mount> find_mount(std::string_view mountinfo, const std::filesystem::path& path) {
  std::optional<Mount> found;
  std::istringstream lines{std::string(mountinfo)};
  // ID PARENT MAJOR:MINOR ROOT POINT OPTIONS [FIELD ...] - TYPE SOURCE OPTIONS
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string id, parent, device, root, options, optional_field, more;
    Mount mount;
    words >> id >> parent >> device >> root >> mount.point >> options;
    mount.point = unescaped(mount.point);
    // Of several mounts at one point, the last one hides the others.
    if (!is_within(path.string(), mount.point)) continue;
    if (found && mount.point.size() < found->point.size()) continue;
    while (words >> optional_field && optional_field != "-") {
    }
    if (!(words >> mount.type >> mount.source >> more)) continue;
    add_options(mount, options);
    add_options(mount, more);
    found = std::move(mount);
  }
  return found;
}

Mount mount_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::canonical(path, error);
  if (error) throw IoError("cannot look at", path, error.value());
  std::ifstream table("/proc/self/mountinfo");  // a file without a size
  const std::string text{std::istreambuf_iterator<char>(table), {}};
  return find_mount(text, canonical).value_or(Mount{});
}

std::uint64_t free_bytes(const std::filesystem::path& path) {
  struct statvfs status {};
  if (::statvfs(path.c_str(), &status) != 0) throw_errno("cannot look at", path);
  return std::uint64_t{status.f_bavail} * status.f_frsize;
}

namespace {

/// Why this many bytes do not fit there; empty: they fit.
std::string problem_with(const std::filesystem::path& folder, std::uint64_t bytes) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return folder.string() + ": " + std::generic_category().message(errno);
  }
  const std::uint64_t room = free_bytes(folder);
  if (room >= bytes) return {};
  return folder.string() + " has " + std::to_string(room >> 20) + " MiB free, and scratch takes " +
         std::to_string((bytes >> 20) + 1) + " MiB";
}

}  // namespace

std::filesystem::path scratch_folder(const std::filesystem::path& wanted,
                                     const std::filesystem::path& otherwise, std::uint64_t bytes) {
  if (wanted.empty()) {
    const char* own = std::getenv("TMPDIR");
    if (own != nullptr && *own != '\0') {
      const std::string problem = problem_with(own, bytes);
      if (problem.empty()) return own;
      log_info("scratch goes to " + otherwise.string() + ", not to TMPDIR: " + problem);
    }
  }
  const std::filesystem::path& folder = wanted.empty() ? otherwise : wanted;
  const std::string problem = problem_with(folder, bytes);
  if (!problem.empty()) {
    throw DataError("no scratch files can be made: " + problem +
                    "; --scratch FOLDER names a disk of this host with room");
  }
  return folder;
}

}  // namespace meshfarm
