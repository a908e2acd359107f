// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A file without a name in $TMPDIR (or /tmp), to be written and read.
struct ScratchFile {
  std::filesystem::path folder;  // for messages
  Fd fd;
};

/// Throws IoError.
ScratchFile make_scratch_file();

}  // namespace meshfarm
