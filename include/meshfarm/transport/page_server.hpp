// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include <meshfarm/transport/page_listener.hpp>

namespace meshfarm {

/// Serves pages to browsers of this host: it listens on 127.0.0.1 only, and answers only who asked
/// for this host, so that no page of another site can read what it says through a name of its own.
class PageServer {
 public:
  /// Serves by threads of its own until it is destroyed. Port 0: any that is free. Throws IoError
  /// if the port is not, Error if the module that serves is not installed.
  PageServer(std::uint16_t port, PageAnswer answer);

  std::uint16_t port() const { return listener_->port(); }

 private:
  std::unique_ptr<PageListener> listener_;
};

}  // namespace meshfarm
