// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Whether an address or interface to listen on is reached from this host only.
bool is_loopback(std::string_view bind);

/// Throws IoError if nothing can listen on this address or interface, whatever the port.
void check_bind(const std::string& bind);

/// The IPv4 address of this host on its first network; nothing if it has none.
std::optional<std::string> network_address();

}  // namespace meshfarm
