// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "farm_fixture.hpp"

namespace meshfarm::test {

inline std::vector<std::string> expected_of(std::size_t jobs) {
  std::vector<std::string> expected;
  for (const Job& job : make_jobs(jobs)) expected.push_back(reversed(job.parameters));
  return expected;
}

/// Runs the three parts to the end and returns the outputs' summaries.
inline std::vector<std::string> run_farm(Farm& farm, const JobSource& source, int workers,
                                         const JobFunction& work = do_trivial_job) {
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(source));
  Part sink(farm.sink(source, summaries));
  std::vector<std::unique_ptr<Part>> crew;
  for (int i = 0; i < workers; ++i) crew.push_back(std::make_unique<Part>(farm.worker(work)));
  sink.join();
  ventilator.join();
  for (auto& worker : crew) {
    // A worker that came after the run was over waits for another run, as it should.
    if (!worker->ended()) worker->stop();
    try {
      worker->join();
    } catch (const IncompleteError&) {
      CHECK(worker->stopped());
    }
  }
  return summaries;
}

/// The trivial job, with its attempts counted.
inline JobFunction counted(std::atomic<int>& attempts) {
  return [&attempts](const Job& job, const JobContext& context) {
    ++attempts;
    return do_trivial_job(job, context);
  };
}

/// The jobs done by several workers. On a busy machine some are attempted twice.
class DoneJobs {
 public:
  /// The trivial job, recorded here.
  JobFunction noting() {
    return [this](const Job& job, const JobContext& context) {
      {
        const std::lock_guard lock(mutex_);
        jobs_.insert(job.parameters);
      }
      return do_trivial_job(job, context);
    };
  }
  /// The number of jobs since the last call. To be called while no worker runs.
  std::size_t take() { return std::exchange(jobs_, {}).size(); }

 private:
  std::mutex mutex_;
  std::set<std::string> jobs_;
};

/// The trivial job, slow enough that all jobs together take a few heartbeats.
inline JobOutput do_slow_job(const Job& job, const JobContext& context) {
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return do_trivial_job(job, context);
}

template <class Predicate>
void wait_until(Predicate predicate) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!predicate() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  REQUIRE(predicate());
}

}  // namespace meshfarm::test
