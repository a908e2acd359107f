// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <zmq.hpp>

#include <meshfarm/util/file.hpp>

#include "transport/run_keys.hpp"

namespace meshfarm {

/// Connections that failed the handshake.
struct Refusals {
  std::uint64_t stated = 0;    // garbage, wrong keys, or another mechanism
  std::uint64_t left_off = 0;  // closed without a stated reason
  /// The refusals to report. A peer that ends while it connects counts as left_off, and so may one
  /// that finds that the server uses another mechanism: a few of these are normal at a run's end.
  std::uint64_t strangers() const;
};

/// Decides which peers may connect to a listening process, by ZeroMQ's authentication protocol
/// (ZAP, rfc.zeromq.org/spec/27), on a thread of its own, and counts refusals. Must exist before
/// any socket of the context is bound, and must be destroyed after all are closed.
class Gatekeeper {
 public:
  /// Without keys it only counts.
  Gatekeeper(zmq::context_t& context, const Keys& keys);
  ~Gatekeeper();
  Gatekeeper(const Gatekeeper&) = delete;
  Gatekeeper& operator=(const Gatekeeper&) = delete;

  /// Counts connections that fail the socket's handshake. Call before binding.
  void watch(zmq::socket_t& socket);
  /// Connections refused so far.
  Refusals refused() const;

 private:
  void run();
  void wake() const;
  void take_new_monitors();
  void answer();
  bool read_events(zmq::socket_t& monitor);

  zmq::context_t& context_;
  std::string client_key_;  // the only key allowed, 32 bytes; empty: no check
  Fd event_;
  zmq::socket_t door_;
  std::atomic<std::uint64_t> refused_{0};   // stated refusals
  std::atomic<std::uint64_t> left_off_{0};  // closed without a stated reason
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  std::vector<zmq::socket_t> new_monitors_;
  std::uint64_t watched_ = 0;
  std::vector<zmq::socket_t> monitors_;  // the thread's own
  std::thread thread_;
};

/// Logs a line at the end of a run if strangers tried to connect.
void tell_of_strangers(std::uint64_t refused_connections, std::uint64_t garbled_messages);

}  // namespace meshfarm
