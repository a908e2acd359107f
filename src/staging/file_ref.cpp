// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/staging/file_ref.hpp>

namespace meshfarm {

void put_file(ByteWriter& out, const FileRef& file) {
  out.put_string(file.name);
  out.put(file.size);
  out.put(file.hash);
}

FileRef get_file(ByteReader& in) {
  FileRef file;
  file.name = in.get_string();
  file.size = in.get<std::uint64_t>();
  file.hash = in.get<std::uint64_t>();
  return file;
}

}  // namespace meshfarm
