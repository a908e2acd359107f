// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/security.hpp>

namespace meshfarm {

/// The two CURVE key pairs of a run (rfc.zeromq.org/spec/26), each key as 40 characters of Z85:
/// binding sockets hold the server's pair, connecting sockets the client's.
struct RunKeys {
  std::string server_public;
  std::string server_secret;
  std::string client_public;
  std::string client_secret;
  friend bool operator==(const RunKeys&, const RunKeys&) = default;
};

/// None: sockets without authentication.
using Keys = std::optional<RunKeys>;

RunKeys make_run_keys();
std::string encode_keys(const RunKeys& keys);
/// Throws DataError naming `what`; also if a secret key does not match its public key.
RunKeys decode_keys(std::string_view file, std::string_view what);

/// The keys of a run, for a listening process: read, or made by the first process. Throws IoError,
/// and DataError if the file is damaged or others can read it.
Keys keys_to_serve(const Stage& stage, std::uint64_t run, const SecurityOptions& security);

/// The keys for a connection to the ventilator that published the endpoint. Throws IoError or
/// DataError, also if it and we disagree about authentication.
Keys keys_to_connect(const Stage& stage, const Endpoint& endpoint, const SecurityOptions& security);

}  // namespace meshfarm
