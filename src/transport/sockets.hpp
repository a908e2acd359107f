// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Every ZeroMQ socket of the farm is made here, with all its options set.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <zmq.hpp>

#include <meshfarm/farm/protocol.hpp>

#include "transport/run_keys.hpp"

namespace meshfarm {

struct PortRange {
  std::uint16_t first = 0;  // 0: any
  std::uint16_t last = 0;
};

/// Allows as many sockets as there may be workers; raises this process's file limit to its hard
/// limit.
zmq::context_t make_context();

// With keys, a server talks only to clients that the context's Gatekeeper admits, and a client only
// to a server that has the server's secret key.
zmq::socket_t make_control_server(zmq::context_t& context, const Keys& keys);
/// `routing_id` must be new for each connection.
zmq::socket_t make_control_client(zmq::context_t& context, const Keys& keys,
                                  std::uint64_t routing_id);
zmq::socket_t make_lane_server(zmq::context_t& context, const Keys& keys);
zmq::socket_t make_lane_client(zmq::context_t& context, const Keys& keys);
zmq::socket_t make_results_server(zmq::context_t& context, const Keys& keys);
zmq::socket_t make_results_client(zmq::context_t& context, const Keys& keys);

/// Binds to the interface or address on the first free port of the range. Returns the address for
/// others to connect to. Throws IoError naming the interface and the ports.
std::string bind_within(zmq::socket_t& socket, const std::string& interface, PortRange range);

/// A random number that is never 0.
std::uint64_t random_id();
std::string host_name();

/// One message from a socket, with the peer's routing id if `socket` is a ROUTER.
struct Received {
  std::string peer;
  std::optional<Message> message;              // none: garbage, which is dropped
  std::optional<std::uint16_t> other_version;  // the protocol version of such a frame
};
/// Takes one message without waiting; nothing if there is none.
std::optional<Received> receive(zmq::socket_t& socket);
/// Sends one frame without waiting, retrying on signals; nothing if it could not be taken.
zmq::send_result_t send_one(zmq::socket_t& socket, zmq::message_t& frame, zmq::send_flags flags);
/// Sends without waiting; false if the message could not be taken.
bool send(zmq::socket_t& socket, const Message& message);
/// Sends to one peer of a ROUTER; also false if the peer is gone.
bool send(zmq::socket_t& router, std::string_view peer, const Message& message);
/// Sends an already encoded frame.
bool send_frame(zmq::socket_t& router, std::string_view peer, std::string_view frame);

/// Waits until one of the items is ready or the timeout is over; a signal ends the wait early.
void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::milliseconds timeout);
FarmTime farm_clock();
/// Processor time used by this thread, or by the clock's thread.
std::uint64_t thread_cpu_us(clockid_t clock = CLOCK_THREAD_CPUTIME_ID);

}  // namespace meshfarm
