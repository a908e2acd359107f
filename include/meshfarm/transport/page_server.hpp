// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace meshfarm {

struct ServedPage {
  std::string type;  // "application/json"
  std::string body;
};

/// Serves pages to browsers of this host: it listens on 127.0.0.1 only, and answers only who asked
/// for this host, so that no page of another site can read what it says through a name of its own.
class PageServer {
 public:
  /// The page of a path ("/", "/status.json"), or nothing. Called by several threads.
  using Answer = std::function<std::optional<ServedPage>(const std::string& path)>;

  /// Serves by threads of its own until it is destroyed. Port 0: any that is free. Throws IoError
  /// if the port is not.
  PageServer(std::uint16_t port, Answer answer);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  std::uint16_t port() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
