// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Where a ventilator listens: the content of control/NNNNNN.endpoint, one file per epoch.
struct Endpoint {
  std::uint32_t epoch = 0;
  std::uint64_t run = 0;
  std::string address;  // tcp://host:port; empty: the run served by the previous epoch is over
  std::string host;
  std::uint32_t pid = 0;
  std::string server_key;  // public, Z85 text; empty: no authentication (--insecure)
  bool done = false;       // the run is over because its output was made
  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

std::string encode_endpoint(const Endpoint& endpoint);
/// Throws DataError naming `what`.
Endpoint decode_endpoint(std::string_view file, std::string_view what);

/// Publishes under the first free number after the highest existing one and fills in `epoch`.
/// `unique`: see Stage::publish. Throws IoError.
Endpoint publish_endpoint(const Stage& stage, Endpoint endpoint, std::string_view unique);

/// Lists the endpoints of a stage, and reads each file once.
class EndpointList {
 public:
  /// The readable endpoints, ascending by epoch; damaged files are left out.
  const std::vector<Endpoint>& look(const Stage& stage);

 private:
  std::vector<Endpoint> known_;
};

}  // namespace meshfarm
