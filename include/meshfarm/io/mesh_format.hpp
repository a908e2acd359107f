// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace meshfarm {

/// Throws DataError if a file of this name would not be what its extension says. A name without an
/// extension is PLY.
void check_output_format(const std::filesystem::path& path);

}  // namespace meshfarm
