// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/sink_core.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {

template <class A>
std::vector<A> only(const SinkActions& actions) {
  std::vector<A> found;
  for (const SinkAction& action : actions) {
    if (const auto* each = std::get_if<A>(&action)) found.push_back(*each);
  }
  return found;
}

/// The sink's messages of type M.
template <class M>
std::vector<M> said(const SinkActions& actions) {
  std::vector<M> found;
  for (const Say& say : only<Say>(actions)) {
    if (const auto* each = std::get_if<M>(&say.message)) found.push_back(*each);
  }
  return found;
}

inline JobKey key(const std::string& name) {
  return key_of(make_job(name));
}

inline JobOutput result_of(JobKey of, std::uint32_t attempt = 1, std::uint64_t incarnation = 5) {
  return {{to_string(ResultName{of.value, attempt, incarnation}), 1, 1}, "made"};
}

/// A sink with a clock, for a run of jobs "job 0", "job 1"...
struct SinkBench {
  explicit SinkBench(std::size_t jobs, std::map<JobKey, JobOutput> journal = {},
                     WhenFull when_full = WhenFull::wait)
      : SinkBench(one_stage(jobs), std::move(journal), when_full) {}
  explicit SinkBench(JobSource source, std::map<JobKey, JobOutput> journal = {},
                     WhenFull when_full = WhenFull::wait)
      : core({Role::sink, 7, 99, 1, "h", "results", FarmTime(10'000)}, std::move(source),
             std::move(journal), when_full) {}

  SinkActions join(std::uint32_t epoch) {
    SinkActions all = core.tick(now);
    const Endpoint there{epoch, 7, "tcp://v", "h", 1};
    const SinkActions dialled = core.found({&there, 1}, now);
    CHECK(only<Dial>(dialled).size() == 1);
    CHECK(said<Hello>(dialled).size() == 1);
    for (SinkAction& each : core.on_control(Welcome{{}, epoch, 7, "", "", 1000}, now)) {
      all.push_back(std::move(each));
    }
    return all;
  }
  SinkActions result(JobKey of, std::uint32_t epoch = 1, std::uint32_t attempt = 1) {
    return core.on_result(
        Result{7, epoch, {3}, 5, attempt, of, result_of(of, attempt), {1, 2, 3, 4}});
  }
  /// The result arrives, and its file is found whole.
  SinkActions accept(JobKey of) {
    const auto checks = only<Check>(result(of));
    REQUIRE(checks.size() == 1);
    return core.checked(checks[0], {}, now);
  }
  /// The files that journals know exist, with the right sizes.
  SinkActions look_at_all(const SinkActions& actions) {
    return answer(actions, Check::What::known);
  }
  /// Files that were looked at are whole.
  SinkActions verify(const SinkActions& actions) { return answer(actions, Check::What::accepted); }
  SinkActions answer(const SinkActions& actions, Check::What what) {
    SinkActions all;
    for (const Check& each : only<Check>(actions)) {
      if (each.what != what) continue;
      for (SinkAction& action : core.checked(each, {}, now)) all.push_back(std::move(action));
    }
    return all;
  }
  SinkActions silence(FarmTime duration) { return core.tick(now += duration); }

  SinkCore core;
  FarmTime now{0};
};

/// A worker's job, followed by one of the sink.
inline JobSource then_own() {
  Job own = make_job("own");
  own.by_sink = true;
  return in_stages({{make_job("job 0")}, {own}});
}

inline std::map<JobKey, JobOutput> journal_of(const std::vector<std::string>& names) {
  std::map<JobKey, JobOutput> journal;
  for (const std::string& name : names) journal[key(name)] = result_of(key(name));
  return journal;
}

}  // namespace meshfarm::test
