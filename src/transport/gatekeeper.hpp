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

/// Connections that did not get through the handshake.
struct Refusals {
  std::uint64_t stated = 0;    // garbage, wrong keys, another mechanism
  std::uint64_t left_off = 0;  // ended without a word
  /// Those to tell of. A peer that ends while it connects leaves off, and so may one that finds
  /// that the server speaks another mechanism: a few of these are usual where a run ends.
  std::uint64_t strangers() const;
};

/// Stands at the doors of a process that listens: says who may come in, by ZeroMQ's authentication
/// protocol (ZAP, rfc.zeromq.org/spec/27), from a thread of its own, and counts who is refused.
/// Must be there before any socket of the context is bound and end after all are closed.
class Gatekeeper {
 public:
  /// Without keys it counts only.
  Gatekeeper(zmq::context_t& context, const Keys& keys);
  ~Gatekeeper();
  Gatekeeper(const Gatekeeper&) = delete;
  Gatekeeper& operator=(const Gatekeeper&) = delete;

  /// Counts those that do not get through the socket's handshake. Call it before binding.
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
  std::string client_key_;  // the one that may come in, 32 bytes; empty: nobody is asked
  Fd event_;
  zmq::socket_t door_;
  std::atomic<std::uint64_t> refused_{0};   // by what they said
  std::atomic<std::uint64_t> left_off_{0};  // without a word
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  std::vector<zmq::socket_t> new_monitors_;
  std::uint64_t watched_ = 0;
  std::vector<zmq::socket_t> monitors_;  // the thread's own
  std::thread thread_;
};

/// A line of log at the end of a run that strangers came to; nothing where none came.
void tell_of_strangers(std::uint64_t refused_connections, std::uint64_t garbled_messages);

}  // namespace meshfarm
