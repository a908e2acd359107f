// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/dispatcher.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {

inline constexpr std::uint64_t k_run = 7;
inline constexpr std::uint32_t k_epoch = 2;

template <class A>
std::vector<A> only(const Actions& actions) {
  std::vector<A> found;
  for (const Action& action : actions) {
    if (const auto* each = std::get_if<A>(&action)) found.push_back(*each);
  }
  return found;
}

/// The messages of type M to this peer among the actions.
template <class M>
std::vector<M> said_to(const PeerId& peer, const Actions& actions) {
  std::vector<M> found;
  for (const SendTo& each : only<SendTo>(actions)) {
    const auto* message = std::get_if<M>(&each.message);
    if (each.peer == peer && message != nullptr) found.push_back(*message);
  }
  return found;
}

/// A Dispatcher with a clock, and shorthands for its peers' messages.
struct Desk {
  explicit Desk(JobSource source, WhenFull when_full = WhenFull::wait)
      : dispatcher(Plan(std::move(source), 3),
                   {.run = k_run, .epoch = k_epoch, .when_full = when_full}) {}

  Actions say(const PeerId& peer, const Message& message) {
    return dispatcher.on_message(peer, message, now);
  }
  /// Joins; the worker's id is 1 plus the number of workers that joined before.
  Actions worker(const PeerId& peer, std::uint64_t incarnation) {
    const Actions opened = say(peer, Hello{Role::worker, 0, incarnation, 1, "host", {}});
    const auto lanes = only<OpenLane>(opened);
    REQUIRE(lanes.size() == 1);
    return dispatcher.lane_opened(lanes[0].worker, "lane");
  }
  Actions sink(const PeerId& peer, std::uint64_t incarnation,
               const std::vector<JobKey>& accepted = {}) {
    say(peer, Hello{Role::sink, k_run, incarnation, 1, "host", "results of " + peer});
    for (const JobKey key : accepted) accept(peer, key, 0);
    return say(peer, Ready{k_epoch, accepted.size()});
  }
  Actions accept(const PeerId& peer, JobKey key, std::uint32_t worker) {
    Accept message;
    message.epoch = k_epoch;
    message.worker = {worker};
    message.key = key;
    return say(peer, message);
  }
  Actions credit(const PeerId& peer, std::uint32_t worker, std::uint64_t up_to) {
    return say(peer, Credit{k_epoch, {worker}, up_to});
  }
  Actions silence(FarmTime duration) { return dispatcher.tick(now += duration); }

  Dispatcher dispatcher;
  FarmTime now{0};
};

inline std::string names(const Actions& actions) {
  std::string names;
  for (const PushJob& push : only<PushJob>(actions)) {
    names += push.assignment.job.parameters + "@" + std::to_string(push.worker.value) + " ";
  }
  return names;
}

inline JobKey key(int i) {
  return key_of(make_jobs(static_cast<std::size_t>(i) + 1).back());
}

}  // namespace meshfarm::test
