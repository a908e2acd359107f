// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/transport/security.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

void check_exposure(const SecurityOptions& security, const std::string& bind) {
  if (security.authentication == Authentication::curve || is_loopback(bind) ||
      security.insecure_exposure == Exposure::network) {
    return;
  }
  throw UsageError("--insecure listens on this host only (--bind 127.0.0.1): at " + bind +
                   " anybody could send results; --insecure-network allows that");
}

}  // namespace meshfarm
