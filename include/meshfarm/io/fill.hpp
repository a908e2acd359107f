// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace meshfarm {

/// Fills the whole buffer with a file's next bytes, or throws.
using Fill = std::function<void(std::span<char>)>;

/// A fill that reads from bytes in memory, which must outlive it. Throws DataError naming `what`.
Fill fill_from(std::string_view bytes, std::string what);

}  // namespace meshfarm
