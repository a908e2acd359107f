// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "byte_stream.hpp"

namespace meshfarm {

/// Whether the bytes start like a zstd file.
bool is_zstd(std::string_view bytes);

/// Throws DataError unless the last frame is whole: the decompressor used here takes a truncated
/// file for a complete one. Reads only the blocks' headers.
void check_zstd_frames(const InputFile& file);

}  // namespace meshfarm
