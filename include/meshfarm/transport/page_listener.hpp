// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace meshfarm {

struct ServedPage {
  std::string type;  // "application/json"
  std::string body;
};

/// The page of a path ("/", "/status.json"), or nothing. Called by several threads.
using PageAnswer = std::function<std::optional<ServedPage>(const std::string& path)>;

/// Loaded by PageServer as a module: its HTTP library takes longer to load than the whole rest of
/// the program.
class PageListener {
 public:
  virtual ~PageListener() = default;
  virtual std::uint16_t port() const = 0;
};

/// The module and its function. It listens on threads of its own until the listener is destroyed.
/// Throws std::system_error if the port is not free.
inline constexpr const char* k_page_module = "libmeshfarm_web.so";
inline constexpr const char* k_page_function = "meshfarm_listen";
using ListenFunction = PageListener*(std::uint16_t port, PageAnswer answer);

}  // namespace meshfarm
