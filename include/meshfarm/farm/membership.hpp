// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

struct MemberOptions {
  Role role = Role::worker;
  std::uint64_t run = 0;  // 0: any
  std::uint64_t incarnation = 0;
  std::uint32_t pid = 0;
  std::string host;
  std::string results;  // the sink's address
  FarmTime patience{60'000};
  Capacity capacity = {};  // a worker's
  std::uint32_t algorithm = 0;
};

/// Look at the stage's endpoints and answer with found().
struct Look {};
/// Open a new connection to a ventilator, under a fresh routing id.
struct Dial {
  std::string address;
};
/// Close the connection to the ventilator.
struct HangUp {};
/// Send this to the ventilator.
struct Say {
  Message message;
};

/// How long to wait for messages before checking the clock.
FarmTime poll_interval(FarmTime heartbeat);

/// How a worker or a sink finds a ventilator, stays with it, and notices that it is gone. Pure:
/// each call reports an event and returns what to do.
class Membership {
 public:
  enum class Event {
    none,
    joined,    // welcome() is new
    lost,      // forget the ventilator: hang up and look for another
    refused,   // permanently; reason() says why
    run_over,  // the ventilator is gone; everything is done or given up
    expired    // looked long enough; reason() says what for
  };

  explicit Membership(MemberOptions options) : options_(std::move(options)) {}

  Event tick(FarmTime now);
  Event on_message(const Message& message, FarmTime now);
  /// The endpoints in the stage. Check dial() and hello() afterwards.
  Event found(std::span<const Endpoint> endpoints, FarmTime now);

  /// Whether it is time to look at the stage's endpoints; asking resets it.
  bool look_due(FarmTime now);
  /// The longest wait for messages before the clock must be checked again.
  FarmTime pause(FarmTime now) const;
  /// The address for a new connection, if any; asking resets it.
  std::optional<std::string> dial();
  /// The greeting to send, if any; asking resets it.
  std::optional<Hello> hello();
  /// Whether a heartbeat is due; asking resets it.
  bool beat_due(FarmTime now);

  bool joined() const { return joined_; }
  const Welcome& welcome() const { return welcome_; }
  FarmTime heartbeat() const { return heartbeat_; }
  /// The epoch of the current or last ventilator.
  std::uint32_t epoch() const { return welcome_.epoch; }
  const MemberOptions& options() const { return options_; }
  const std::string& reason() const { return reason_; }

 private:
  Event lose(FarmTime now);
  const Endpoint* choose(std::span<const Endpoint* const> live, FarmTime now);
  void greet(const Endpoint& endpoint, FarmTime now);
  FarmTime second_beat_after() const;
  Event on_refused(const Refused& refused, FarmTime now);
  Event on_welcome(const Welcome& welcome, FarmTime now);

  MemberOptions options_;
  bool joined_ = false;
  Welcome welcome_;
  FarmTime heartbeat_{1000};
  std::optional<FarmTime> alone_since_;
  std::optional<FarmTime> next_look_;
  FarmTime look_pause_{5};
  FarmTime heard_{0};
  FarmTime next_beat_{0};
  bool first_beat_ = false;  // the next beat is the first one since joining
  std::optional<Endpoint> dialled_;
  bool seen_over_ = false;
  bool seen_other_run_ = false;
  std::uint32_t newest_seen_ = 0;  // the epoch
  bool lost_ = false;              // the ventilator dialled last, and not dialled again since
  int greetings_ = 0;
  bool dial_ = false;
  bool greet_ = false;
  std::string reason_;
};

}  // namespace meshfarm
