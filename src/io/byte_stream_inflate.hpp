// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include "byte_stream.hpp"

namespace meshfarm {

/// The decompressed bytes of `file`, which must outlive the stream. Damage throws DataError naming
/// the file and how far decompression got.
std::unique_ptr<ByteStream> open_compressed(const InputFile& file);

}  // namespace meshfarm
