// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "scratch_file.hpp"

#include <cstdlib>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

ScratchFile make_scratch_file() {
  ScratchFile file;
  std::error_code error;
  file.folder = std::filesystem::temp_directory_path(error);
  if (error) throw IoError("cannot keep scratch in", file.folder, error.value());
  std::string name = (file.folder / "meshfarm.XXXXXX").string();
  file.fd = Fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!file.fd) throw_errno("cannot make", name);
  ::unlink(name.c_str());
  return file;
}

}  // namespace meshfarm
