// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

namespace meshfarm {

inline constexpr const char* k_version = MESHFARM_VERSION;

}  // namespace meshfarm
