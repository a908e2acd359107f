// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/page_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

PageFile::PageFile(const std::filesystem::path& folder) : folder_(folder) {
  std::string name = (folder / "scratch.XXXXXX").string();
  fd_ = Fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!fd_) throw_errno("cannot make", name);
  ::unlink(name.c_str());
}

void PageFile::read(std::uint64_t offset, std::span<char> out) const {
  const std::size_t got = read_at(fd_.get(), offset, out, folder_);
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(got), out.end(), '\0');
}

void PageFile::write(std::uint64_t offset, std::span<const char> bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t put = ::pwrite(fd_.get(), bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(offset + done));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_errno("cannot write a scratch file in", folder_);
    done += static_cast<std::size_t>(put);
  }
}

}  // namespace meshfarm
