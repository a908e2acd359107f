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
  std::uint64_t run = 0;  // 0: whichever
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
/// Connect to a ventilator anew, under a fresh routing id.
struct Dial {
  std::string address;
};
/// Close what leads to the ventilator.
struct HangUp {};
/// Say to the ventilator.
struct Say {
  Message message;
};

/// How long to wait for messages before the clock is looked at.
FarmTime poll_interval(FarmTime heartbeat);

/// How a worker or a sink finds a ventilator, stays with it, and notices that it is gone. Pure:
/// each call says what happened, the answer says what to do.
class Membership {
 public:
  enum class Event {
    none,
    joined,    // welcome() is new
    lost,      // forget the ventilator: hang up, look for another
    refused,   // for ever; reason() says why
    run_over,  // the ventilator is gone, all is done or given up
    expired    // looked long enough; reason() says for what
  };

  explicit Membership(MemberOptions options) : options_(std::move(options)) {}

  Event tick(FarmTime now);
  Event on_message(const Message& message, FarmTime now);
  /// What the stage shows. Afterwards dial() and hello() may want something.
  Event found(std::span<const Endpoint> endpoints, FarmTime now);

  /// Whether to look at the stage's endpoints now; asking resets it.
  bool look_due(FarmTime now);
  /// How long to wait for messages before the clock is to be looked at again, at most.
  FarmTime pause(FarmTime now) const;
  /// An address to connect to anew, if any; asking resets it.
  std::optional<std::string> dial();
  /// A greeting to say, if any; asking resets it.
  std::optional<Hello> hello();
  /// Whether a heartbeat is to be said now; asking resets it.
  bool beat_due(FarmTime now);

  bool joined() const { return joined_; }
  const Welcome& welcome() const { return welcome_; }
  FarmTime heartbeat() const { return heartbeat_; }
  /// The epoch of the ventilator joined now or last.
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
  bool first_beat_ = false;  // the next one is the first since it joined
  std::optional<Endpoint> dialled_;
  bool seen_over_ = false;
  bool seen_other_run_ = false;
  std::uint32_t newest_seen_ = 0;  // epoch
  bool lost_ = false;              // the ventilator dialled last, and not dialled again yet
  int greetings_ = 0;
  bool dial_ = false;
  bool greet_ = false;
  std::string reason_;
};

}  // namespace meshfarm
