// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/gatekeeper.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "transport/sockets.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_key_bytes = 32;
constexpr int k_told = ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;
constexpr int k_refusals = k_told | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL;
/// Members that end while they connect, as at the end of a short run, also count as left_off.
constexpr std::uint64_t k_usually_left_off = 16;
constexpr std::chrono::milliseconds k_for_ever{-1};

std::string raw_key(const std::string& z85) {
  std::array<std::uint8_t, k_key_bytes> bytes{};
  if (::zmq_z85_decode(bytes.data(), z85.c_str()) == nullptr) throw Error("a key is not Z85");
  return {bytes.begin(), bytes.end()};
}

/// All frames of a message; empty if there is no message.
std::vector<std::string> receive_frames(zmq::socket_t& socket) {
  std::vector<std::string> frames;
  zmq::message_t frame;
  try {
    while (socket.recv(frame, zmq::recv_flags::dontwait)) {
      frames.push_back(frame.to_string());
      if (!frame.more()) break;
    }
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
  }
  return frames;
}

}  // namespace

Gatekeeper::Gatekeeper(zmq::context_t& context, const Keys& keys)
    : context_(context),
      client_key_(keys ? raw_key(keys->client_public) : std::string()),
      event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      door_(context, zmq::socket_type::rep) {
  if (!event_) throw_errno("cannot make", "an eventfd");
  door_.set(zmq::sockopt::linger, 0);
  door_.bind("inproc://zeromq.zap.01");
  thread_ = std::thread([this] { run(); });
}

Gatekeeper::~Gatekeeper() {
  ending_ = true;
  wake();
  thread_.join();
}

void Gatekeeper::watch(zmq::socket_t& socket) {
  const std::string address = "inproc://monitor-" + std::to_string(++watched_);
  if (::zmq_socket_monitor(socket.handle(), address.c_str(),
                           k_refusals | ZMQ_EVENT_MONITOR_STOPPED) != 0) {
    throw zmq::error_t();
  }
  zmq::socket_t monitor(context_, zmq::socket_type::pair);
  monitor.set(zmq::sockopt::linger, 0);
  monitor.set(zmq::sockopt::rcvhwm, 0);  // a full one would stop the context's I/O thread
  monitor.connect(address);
  {
    const std::lock_guard lock(mutex_);
    new_monitors_.push_back(std::move(monitor));
  }
  wake();
}

void Gatekeeper::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto ignored = ::write(event_.get(), &one, sizeof one);
}

void Gatekeeper::run() {
  while (!ending_) {
    std::vector<zmq::pollitem_t> items = {{nullptr, event_.get(), ZMQ_POLLIN, 0},
                                          {door_.handle(), 0, ZMQ_POLLIN, 0}};
    for (zmq::socket_t& monitor : monitors_) items.push_back({monitor.handle(), 0, ZMQ_POLLIN, 0});
    wait_for(items, k_for_ever);
    if ((items[1].revents & ZMQ_POLLIN) != 0) answer();
    for (std::size_t i = monitors_.size(); i-- > 0;) {
      if ((items[i + 2].revents & ZMQ_POLLIN) == 0 || read_events(monitors_[i])) continue;
      monitors_.erase(monitors_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (items[0].revents != 0) take_new_monitors();
  }
}

void Gatekeeper::take_new_monitors() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto ignored = ::read(event_.get(), &count, sizeof count);
  const std::lock_guard lock(mutex_);
  for (zmq::socket_t& each : new_monitors_) monitors_.push_back(std::move(each));
  new_monitors_.clear();
}

/// Answers a request: version, its id, domain, address, routing id, mechanism, credentials.
void Gatekeeper::answer() {
  const std::vector<std::string> request = receive_frames(door_);
  if (request.empty()) return;
  const bool asked_well = request.size() == 7 && request[0] == "1.0" && request[5] == "CURVE";
  const bool known = asked_well && !client_key_.empty() && request[6] == client_key_;
  if (asked_well && !known) log_debug("refused: a peer at " + request[3] + " with a wrong key");
  const std::array<std::string, 6> reply = {"1.0",
                                            request.size() > 1 ? request[1] : std::string(),
                                            known ? "200" : "400",
                                            known ? "OK" : "not of this run",
                                            {},
                                            {}};
  for (std::size_t i = 0; i < reply.size(); ++i) {
    const auto more = i + 1 < reply.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
    zmq::message_t frame(reply[i]);
    send_one(door_, frame, more);
  }
}

/// Counts events; false once the socket is closed.
bool Gatekeeper::read_events(zmq::socket_t& monitor) {
  for (;;) {
    const std::vector<std::string> frames = receive_frames(monitor);
    if (frames.empty()) return true;
    std::uint16_t event = 0;
    if (frames[0].size() >= sizeof event) std::memcpy(&event, frames[0].data(), sizeof event);
    if (event == ZMQ_EVENT_MONITOR_STOPPED) return false;
    if ((event & k_refusals) == 0) continue;
    ((event & k_told) != 0 ? refused_ : left_off_).fetch_add(1, std::memory_order_relaxed);
  }
}

Refusals Gatekeeper::refused() const {
  return {refused_.load(std::memory_order_relaxed), left_off_.load(std::memory_order_relaxed)};
}

std::uint64_t Refusals::strangers() const {
  return stated + (left_off > k_usually_left_off ? left_off : 0);
}

void tell_of_strangers(std::uint64_t refused_connections, std::uint64_t garbled_messages) {
  if (refused_connections > 0) {
    log_warning("refused " + std::to_string(refused_connections) +
                " connections that did not prove to belong to this run");
  }
  if (garbled_messages > 0) {
    log_warning("dropped " + std::to_string(garbled_messages) +
                " messages that are none of this version of the protocol");
  }
}

}  // namespace meshfarm
