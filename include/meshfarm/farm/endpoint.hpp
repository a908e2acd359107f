// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Where a ventilator listens: the content of control/NNNNNN.endpoint, one file an epoch.
struct Endpoint {
  std::uint32_t epoch = 0;
  std::uint64_t run = 0;
  std::string address;  // tcp://host:port; empty: the run that the epoch before served is over
  std::string host;
  std::uint32_t pid = 0;
  std::string server_key;  // public, as Z85 text; empty: whoever comes is believed (--insecure)
  bool done = false;       // the run is over because its output was made
  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

std::string encode_endpoint(const Endpoint& endpoint);
/// Throws DataError naming `what`.
Endpoint decode_endpoint(std::string_view file, std::string_view what);

/// Publishes under the first number that nobody has taken (fills in `epoch`), the one after the
/// highest that exists. `unique`: see Stage::publish. Throws IoError.
Endpoint publish_endpoint(const Stage& stage, Endpoint endpoint, std::string_view unique);

/// Lists the endpoints of a stage, and reads each file once.
class EndpointList {
 public:
  /// Those that can be read, ascending by epoch; what is damaged is left out.
  const std::vector<Endpoint>& look(const Stage& stage);

 private:
  std::vector<Endpoint> known_;
};

}  // namespace meshfarm
