// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "files_beside.hpp"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <meshfarm/util/errors.hpp>

#include "byte_stream.hpp"

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

bool is_same_but_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

/// The first, by name, of the files with this name in any case of letters.
std::optional<fs::path> find_in_any_case(const fs::path& path) {
  const std::string wanted = path.filename().string();
  std::optional<fs::path> found;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path& each = at->path();
    if (!is_same_but_case(each.filename().string(), wanted) || !is_file(each)) continue;
    if (!found || each < *found) found = each;
  }
  return found;
}

}  // namespace

bool is_beneath(const fs::path& path) {
  if (path.empty() || path.is_absolute() || !path.has_filename()) return false;
  if (path.native().find('\0') != std::string::npos) return false;
  return std::none_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
}

std::optional<fs::path> find_beside(const fs::path& folder, std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '\\', '/');
  const fs::path whole(text);
  std::vector<fs::path> endings;
  for (auto first = whole.begin(); first != whole.end(); ++first) {
    fs::path ending;
    for (auto part = first; part != whole.end(); ++part) ending /= *part;
    if (is_beneath(ending)) endings.push_back(std::move(ending));
  }
  for (const fs::path& path : endings) {
    if (is_file(folder / path)) return folder / path;
  }
  for (const fs::path& path : endings) {
    if (auto found = find_in_any_case(folder / path)) return found;
  }
  return std::nullopt;
}

std::string read_beside(const fs::path& path, std::uint64_t most_bytes) {
  const InputFile file(path);
  if (file.size() > most_bytes) {
    throw DataError(path.string() + ": has " + std::to_string(file.size()) +
                    " bytes, more than the most, " + std::to_string(most_bytes));
  }
  std::string bytes(file.size(), '\0');
  file.read(0, bytes);
  return bytes;
}

}  // namespace meshfarm
