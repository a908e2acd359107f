// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace meshfarm {

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

}  // namespace meshfarm
