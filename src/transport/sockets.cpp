// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/sockets.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <random>

#include <sys/resource.h>
#include <unistd.h>

#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr int k_max_sockets = 60'000;
/// How long the last messages may take to be sent when a process leaves.
constexpr int k_linger_ms = 1000;

/// Common settings of all sockets: they notice a dead peer within seconds, never wait for one at
/// the end, and take no frame longer than the protocol's limit.
zmq::socket_t make(zmq::context_t& context, zmq::socket_type type, int linger_ms) {
  zmq::socket_t socket(context, type);
  socket.set(zmq::sockopt::linger, linger_ms);
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(k_max_frame_bytes));
  socket.set(zmq::sockopt::backlog, 4096);
  // The kernel detects a dead host: one that acknowledges neither data nor a probe for 3 s. We do
  // not use libzmq's heartbeats: up to 4.3.5, one that is due on a connection that broke with
  // unread messages aborts the process (`!_io_error` in stream_engine_base.cpp).
  socket.set(zmq::sockopt::tcp_maxrt, 3000);
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::tcp_keepalive_idle, 1);
  socket.set(zmq::sockopt::tcp_keepalive_intvl, 1);
  socket.set(zmq::sockopt::tcp_keepalive_cnt, 3);
  socket.set(zmq::sockopt::handshake_ivl, 5000);
  socket.set(zmq::sockopt::connect_timeout, 3000);
  socket.set(zmq::sockopt::reconnect_ivl, 100);
  socket.set(zmq::sockopt::reconnect_ivl_max, 5000);
  // The protocol bounds outstanding messages; a send limit here would only lose messages. The
  // receive limit keeps its default, so that a flood waits at its sender.
  socket.set(zmq::sockopt::sndhwm, 0);
  return socket;
}

zmq::socket_t make_server(zmq::context_t& context, const Keys& keys, zmq::socket_type type,
                          int linger_ms) {
  zmq::socket_t socket = make(context, type, linger_ms);
  if (keys) {
    socket.set(zmq::sockopt::curve_server, 1);
    socket.set(zmq::sockopt::curve_secretkey, keys->server_secret);
    socket.set(zmq::sockopt::zap_domain, "meshfarm");
  }
  return socket;
}

zmq::socket_t make_client(zmq::context_t& context, const Keys& keys, zmq::socket_type type,
                          int linger_ms) {
  zmq::socket_t socket = make(context, type, linger_ms);
  if (keys) {
    socket.set(zmq::sockopt::curve_serverkey, keys->server_public);
    socket.set(zmq::sockopt::curve_publickey, keys->client_public);
    socket.set(zmq::sockopt::curve_secretkey, keys->client_secret);
  }
  return socket;
}

/// A bound address as others can connect to it.
std::string advertised(const std::string& bound) {
  for (const std::string_view any : {"tcp://0.0.0.0:", "tcp://[::]:"}) {
    if (bound.compare(0, any.size(), any) == 0) {
      return "tcp://" + network_address().value_or(host_name()) + ":" + bound.substr(any.size());
    }
  }
  return bound;
}

bool try_bind(zmq::socket_t& socket, const std::string& address, int& error_number) {
  try {
    socket.bind(address);
    return true;
  } catch (const zmq::error_t& error) {
    error_number = error.num();
    return false;
  }
}

bool receive_frame(zmq::socket_t& socket, zmq::message_t& frame) {
  try {
    return socket.recv(frame, zmq::recv_flags::dontwait).has_value();
  } catch (const zmq::error_t& error) {
    if (error.num() == EINTR) return false;  // a signal; the loop retries
    throw;
  }
}

std::optional<Message> decode_quietly(const zmq::message_t& frame) {
  try {
    return decode({static_cast<const char*>(frame.data()), frame.size()});
  } catch (const DataError& error) {
    log_debug("dropped: " + std::string(error.what()));
    return std::nullopt;
  }
}

zmq::message_t frame_of(const Message& message) {
  const std::string bytes = encode(message);
  return {bytes.data(), bytes.size()};
}

}  // namespace

zmq::context_t make_context() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) == 0 && files.rlim_cur < files.rlim_max) {
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);  // if refused, the old limit refuses workers later
  }
  return zmq::context_t(1, k_max_sockets);
}

zmq::socket_t make_control_server(zmq::context_t& context, const Keys& keys) {
  zmq::socket_t socket = make_server(context, keys, zmq::socket_type::router, k_linger_ms);
  socket.set(zmq::sockopt::router_mandatory, 1);
  return socket;
}

zmq::socket_t make_control_client(zmq::context_t& context, const Keys& keys,
                                  std::uint64_t routing_id) {
  zmq::socket_t socket = make_client(context, keys, zmq::socket_type::dealer, k_linger_ms);
  // An id must not begin with a zero byte; 'm' does not.
  std::string id = "m";
  id.append(reinterpret_cast<const char*>(&routing_id), sizeof routing_id);
  socket.set(zmq::sockopt::routing_id, id);
  return socket;
}

zmq::socket_t make_lane_server(zmq::context_t& context, const Keys& keys) {
  return make_server(context, keys, zmq::socket_type::push, 0);
}

zmq::socket_t make_lane_client(zmq::context_t& context, const Keys& keys) {
  return make_client(context, keys, zmq::socket_type::pull, 0);
}

zmq::socket_t make_results_server(zmq::context_t& context, const Keys& keys) {
  return make_server(context, keys, zmq::socket_type::pull, 0);
}

zmq::socket_t make_results_client(zmq::context_t& context, const Keys& keys) {
  return make_client(context, keys, zmq::socket_type::push, k_linger_ms);
}

std::string bind_within(zmq::socket_t& socket, const std::string& interface, PortRange range) {
  const std::string host = "tcp://" + interface + ":";
  int error_number = 0;
  bool bound = false;
  if (range.first == 0) {
    bound = try_bind(socket, host + "*", error_number);
  } else {
    for (std::uint32_t port = range.first; port <= range.last && !bound; ++port) {
      bound = try_bind(socket, host + std::to_string(port), error_number);
      if (!bound && error_number != EADDRINUSE) break;
    }
  }
  if (!bound) {
    const std::string ports = range.first == 0 ? std::string("any port")
                                               : "the ports " + std::to_string(range.first) + "-" +
                                                     std::to_string(range.last);
    throw IoError("cannot listen on " + ports + " of", interface, error_number);
  }
  return advertised(socket.get(zmq::sockopt::last_endpoint));
}

std::uint64_t random_id() {
  std::random_device device;
  std::uint64_t id = 0;
  while (id == 0) id = (std::uint64_t{device()} << 32) | device();
  return id;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  return name.data();
}

std::optional<Received> receive(zmq::socket_t& socket) {
  const bool router = socket.get(zmq::sockopt::type) == ZMQ_ROUTER;
  Received received;
  zmq::message_t frame;
  if (!receive_frame(socket, frame)) return std::nullopt;
  if (router) {
    received.peer = frame.to_string();
    if (!frame.more()) return received;
    if (!receive_frame(socket, frame)) return received;
  }
  if (!frame.more()) {
    received.message = decode_quietly(frame);
    if (!received.message) {
      received.other_version =
          other_version_of({static_cast<const char*>(frame.data()), frame.size()});
    }
    return received;
  }
  while (frame.more() && receive_frame(socket, frame)) {
  }
  log_debug("dropped: a message of many frames");
  return received;
}

zmq::send_result_t send_one(zmq::socket_t& socket, zmq::message_t& frame, zmq::send_flags flags) {
  for (;;) {
    try {
      return socket.send(frame, flags | zmq::send_flags::dontwait);
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR) throw;
    }
  }
}

bool send(zmq::socket_t& socket, const Message& message) {
  zmq::message_t frame = frame_of(message);
  return send_one(socket, frame, zmq::send_flags::none).has_value();
}

bool send(zmq::socket_t& router, std::string_view peer, const Message& message) {
  return send_frame(router, peer, encode(message));
}

bool send_frame(zmq::socket_t& router, std::string_view peer, std::string_view frame) {
  zmq::message_t body(frame.data(), frame.size());
  try {
    zmq::message_t head(peer.data(), peer.size());
    if (!send_one(router, head, zmq::send_flags::sndmore)) return false;
    return send_one(router, body, zmq::send_flags::none).has_value();
  } catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return false;
    throw;
  }
}

void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::milliseconds timeout) {
  try {
    zmq::poll(items, timeout);
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
    for (zmq::pollitem_t& item : items) item.revents = 0;
  }
}

FarmTime farm_clock() {
  return std::chrono::duration_cast<FarmTime>(std::chrono::steady_clock::now().time_since_epoch());
}

std::uint64_t thread_cpu_us(clockid_t clock) {
  timespec used{};
  if (::clock_gettime(clock, &used) != 0) return 0;
  return static_cast<std::uint64_t>(used.tv_sec) * 1'000'000 +
         static_cast<std::uint64_t>(used.tv_nsec) / 1000;
}

}  // namespace meshfarm
