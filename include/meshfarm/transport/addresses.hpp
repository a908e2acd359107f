// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Whether an address or interface to listen on can be reached from this host only.
bool is_loopback(std::string_view bind);

/// Throws IoError if it is impossible to listen on this address or interface, on any port.
void check_bind(const std::string& bind);

/// The IPv4 address of this host on its first network; nothing if there is none.
std::optional<std::string> network_address();

}  // namespace meshfarm
