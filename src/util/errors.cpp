// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <system_error>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

IoError::IoError(std::string_view action, const std::filesystem::path& path, int error_number)
    : Error(std::string(action) + " " + path.string() + ": " +
            std::generic_category().message(error_number)),
      error_number_(error_number) {}

bool is_no_space(const IoError& error) {
  return error.error_number() == ENOSPC || error.error_number() == EDQUOT;
}

void throw_errno(std::string_view action, const std::filesystem::path& path) {
  throw IoError(action, path, errno);
}

}  // namespace meshfarm
