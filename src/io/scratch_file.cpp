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
  file.folder = temporary_folder();
  std::string name = (file.folder / "meshfarm.XXXXXX").string();
  file.fd = Fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!file.fd) throw_errno("cannot make", name);
  ::unlink(name.c_str());
  return file;
}

}  // namespace meshfarm
