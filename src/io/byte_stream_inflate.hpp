// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include "byte_stream.hpp"

namespace meshfarm {

/// The decompressed bytes of `file`, which must outlive the stream. Damage throws DataError naming
/// `path` and how far decompression came.
std::unique_ptr<ByteStream> open_compressed(const MappedFile& file, Compression compression,
                                            const std::filesystem::path& path);

}  // namespace meshfarm
