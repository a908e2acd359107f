// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/output_place.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/staging/names.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/cut_record.hpp"

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

bool are_same(const fs::path& a, const fs::path& b) {
  std::error_code not_there;
  if (fs::equivalent(a, b, not_there)) return true;
  std::error_code unknown;
  const fs::path one = fs::weakly_canonical(a, unknown);
  if (unknown) return false;
  const fs::path other = fs::weakly_canonical(b, unknown);
  return !unknown && one == other;
}

[[noreturn]] void refuse(std::string_view option, const std::string& output,
                         const std::string& other) {
  throw UsageError(std::string(option) + " " + output + ": would write over " + other);
}

}  // namespace

void check_writable(const std::string& output) {
  check_output_format(output);
  check_place(output);
}

void check_place(const std::string& output) {
  if (output.empty()) throw UsageError("the name of the file to write is empty");
  if (output.front() == '-') {
    throw UsageError(output + ": begins with '-'; a file of this name is ./" + output);
  }
  const fs::path path(output);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code unknown;
  const fs::file_status there = fs::status(path, unknown);
  if (fs::is_directory(there)) throw IoError("cannot write over the folder", path, EISDIR);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw IoError("cannot write over what is no regular file", path, EINVAL);
  }
  // The file gets its name when it is complete: that would replace the link, as of /dev/stdout.
  if (fs::is_symlink(fs::symlink_status(path, unknown))) {
    throw UsageError(output + ": is a link; give the name of the file to write");
  }
  const fs::file_status around = fs::status(folder, unknown);
  if (fs::exists(around) && !fs::is_directory(around)) {
    throw IoError("cannot write into", folder, ENOTDIR);
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw_errno("cannot write into", folder);
}

void check_not_over(std::string_view option, const std::string& output, std::string_view what,
                    const std::string& other) {
  if (are_same(output, other)) refuse(option, output, std::string(what) + " " + other);
}

void check_not_of_stage(std::string_view option, const std::string& output,
                        const std::string& stage) {
  std::error_code not_there;
  const fs::path root = fs::canonical(stage, not_there);
  if (not_there || !fs::is_directory(root, not_there)) return;
  const fs::path path = fs::weakly_canonical(output, not_there);
  if (!not_there && parse_staged_name(path.lexically_relative(root).string())) {
    refuse(option, output, "a file of the stage " + stage);
  }
  if (!holds_cut(stage) || !fs::is_regular_file(output, not_there)) return;
  if (is_of_input(Stage::open(stage), output)) {
    refuse(option, output, "what the stage " + stage + " was cut from");
  }
}

}  // namespace meshfarm
