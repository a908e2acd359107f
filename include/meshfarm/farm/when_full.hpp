// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// What a run does when the disk, or its owner's quota, is full: it waits until there is room, or
/// ends and can be resumed.
enum class WhenFull : std::uint8_t { wait, end };

}  // namespace meshfarm
