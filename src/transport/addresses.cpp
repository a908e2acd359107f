// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <meshfarm/transport/addresses.hpp>

#include "transport/sockets.hpp"

namespace meshfarm {
namespace {

using Interfaces = std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)>;

/// The first of this host's interfaces (a linked list); null if they cannot be listed.
Interfaces list_interfaces() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) list = nullptr;
  return {list, &::freeifaddrs};
}

}  // namespace

bool is_loopback(std::string_view bind) {
  if (bind == "localhost" || bind == "[::1]" || bind == "::1") return true;
  in_addr address{};
  if (::inet_pton(AF_INET, std::string(bind).c_str(), &address) == 1) {
    return (ntohl(address.s_addr) >> 24) == 127;
  }
  const Interfaces interfaces = list_interfaces();
  for (const ifaddrs* each = interfaces.get(); each != nullptr; each = each->ifa_next) {
    if (bind == each->ifa_name) return (each->ifa_flags & IFF_LOOPBACK) != 0;
  }
  return false;
}

void check_bind(const std::string& bind) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::pull);
  bind_within(socket, bind, {});
}

std::optional<std::string> network_address() {
  const Interfaces interfaces = list_interfaces();
  for (const ifaddrs* each = interfaces.get(); each != nullptr; each = each->ifa_next) {
    const bool usable = each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                        (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!usable) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr) {
      return text.data();
    }
  }
  return std::nullopt;
}

}  // namespace meshfarm
