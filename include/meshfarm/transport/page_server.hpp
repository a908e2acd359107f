// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include <meshfarm/transport/page_listener.hpp>

namespace meshfarm {

/// Serves pages to browsers on this host. It listens on 127.0.0.1 only, and answers only requests
/// whose Host header names this host, so that a page of another site cannot read the answers
/// through a domain name of its own.
class PageServer {
 public:
  /// Serves on threads of its own until it is destroyed. Port 0: any free port. Throws IoError if
  /// the port is not free, Error if the serving module is not installed.
  PageServer(std::uint16_t port, PageAnswer answer);

  std::uint16_t port() const { return listener_->port(); }

 private:
  std::unique_ptr<PageListener> listener_;
};

}  // namespace meshfarm
