// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <meshfarm/farm/security.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

bool is_loopback(std::string_view bind) {
  if (bind == "localhost" || bind == "[::1]" || bind == "::1") return true;
  in_addr address{};
  if (::inet_pton(AF_INET, std::string(bind).c_str(), &address) == 1) {
    return (ntohl(address.s_addr) >> 24) == 127;
  }
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return false;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (bind == each->ifa_name) return (each->ifa_flags & IFF_LOOPBACK) != 0;
  }
  return false;
}

void check_exposure(const SecurityOptions& security, const std::string& bind) {
  if (security.authentication == Authentication::curve || is_loopback(bind) ||
      security.insecure_exposure == Exposure::network) {
    return;
  }
  throw UsageError("--insecure listens on this host only (--bind 127.0.0.1): at " + bind +
                   " anybody could send results; --insecure-network allows that");
}

}  // namespace meshfarm
