// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// The encoding in files and messages: name | size u64 | hash u64.
void put_file(ByteWriter& out, const FileRef& file);
FileRef get_file(ByteReader& in);

}  // namespace meshfarm
