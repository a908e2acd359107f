// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <zmq.hpp>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/farm/membership.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "transport/run_keys.hpp"
#include "transport/sockets.hpp"

namespace meshfarm {

/// A worker's or sink's end of the control channel: executes what Membership requests.
class ControlLink {
 public:
  ControlLink(zmq::context_t& context, const Stage& stage, const SecurityOptions& security)
      : context_(context), stage_(stage), security_(security) {}

  /// The endpoints now in the stage; unchanged if it cannot be listed (NFS not reachable).
  const std::vector<Endpoint>& look() {
    try {
      endpoints_ = list_.look(stage_);
    } catch (const IoError& error) {
      log_debug(error.what());
    }
    return endpoints_;
  }
  void dial(const std::string& address) {
    socket_.reset();
    if (!find_keys(address)) return;  // dialled again after a while
    socket_.emplace(make_control_client(context_, keys_, random_id()));
    try {
      socket_->connect(address);
    } catch (const zmq::error_t& error) {
      log_debug("cannot connect to " + address + ": " + error.what());
    }
  }
  void hang_up() {
    if (socket_) socket_->set(zmq::sockopt::linger, 0);
    socket_.reset();
  }
  void say(const Message& message) {
    if (socket_) send(*socket_, message);  // lost messages are repeated
  }
  zmq::socket_t* socket() { return socket_ ? &*socket_ : nullptr; }
  /// The keys of the run dialled last.
  const Keys& keys() const { return keys_; }

 private:
  bool find_keys(const std::string& address) {
    const auto endpoint = std::find_if(endpoints_.rbegin(), endpoints_.rend(),
                                       [&](const Endpoint& e) { return e.address == address; });
    if (endpoint == endpoints_.rend()) return false;
    try {
      keys_ = keys_to_connect(stage_, *endpoint, security_);
      return true;
    } catch (const Error& error) {
      if (problem_ != error.what()) log_warning(error.what());
      problem_ = error.what();
      return false;
    }
  }

  zmq::context_t& context_;
  const Stage& stage_;
  const SecurityOptions& security_;
  Keys keys_;
  std::string problem_;
  EndpointList list_;
  std::vector<Endpoint> endpoints_;
  std::optional<zmq::socket_t> socket_;
};

}  // namespace meshfarm
