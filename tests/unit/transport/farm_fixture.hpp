// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/transport/sink.hpp>
#include <meshfarm/transport/ventilator.hpp>
#include <meshfarm/transport/worker.hpp>

#include "support/jobs.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm::test {

/// What the trivial job publishes: its own parameters, reversed.
inline std::string reversed(const std::string& text) {
  return {text.rbegin(), text.rend()};
}

inline JobOutput do_trivial_job(const Job& job, const JobContext& context) {
  context.progress(job.cost);
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  const std::string bytes = reversed(job.parameters);
  return {context.stage.publish(name, bytes), bytes};
}

/// A thread that runs one part of the farm and keeps the exception that ended it.
class Part {
 public:
  explicit Part(std::function<void(const std::atomic<bool>& stop)> run)
      : thread_([this, run = std::move(run)] {
          try {
            run(stop_);
          } catch (...) {
            error_ = std::current_exception();
          }
          ended_ = true;
        }) {}
  ~Part() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void stop() { stop_ = true; }
  bool stopped() const { return stop_; }
  bool ended() const { return ended_; }
  /// Waits for the end and rethrows that exception.
  void join() {
    thread_.join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<bool> ended_{false};
  std::exception_ptr error_;
  std::thread thread_;
};

/// A stage in a temporary folder, and options for the three parts that make them quick.
struct Farm {
  TempFolder folder;
  Stage stage = Stage::create(folder / "stage");
  std::uint64_t run = 7;
  std::chrono::milliseconds heartbeat{200};
  std::chrono::milliseconds patience{20'000};
  std::chrono::milliseconds hang{30'000};
  WhenFull when_full = WhenFull::wait;
  SchedulerOptions schedule = {};

  auto ventilator(JobSource source, std::function<void(const FarmProgress&)> progress = {}) {
    VentilatorOptions options;
    options.run = run;
    options.heartbeat = heartbeat;
    options.hang = hang;
    options.when_full = when_full;
    options.schedule = schedule;
    options.progress = std::move(progress);
    return [this, source, options](const std::atomic<bool>& stop) mutable {
      options.stop = &stop;
      run_ventilator(stage, source, options);
    };
  }
  auto worker(JobFunction work = do_trivial_job, std::uint32_t buffer = 3) {
    WorkerOptions options;
    options.buffer = buffer;
    options.patience = patience;
    return [this, work, options](const std::atomic<bool>& stop) mutable {
      options.stop = &stop;
      run_worker(stage, work, options);
    };
  }
  auto sink(JobSource source, std::vector<std::string>& summaries,
            std::function<void(std::string_view, const JobOutput&)> inspect = {}) {
    SinkOptions options;
    options.inspect = std::move(inspect);
    options.when_full = when_full;
    options.run = run;
    options.patience = patience;
    return [this, source, options, &summaries](const std::atomic<bool>& stop) mutable {
      options.stop = &stop;
      run_sink(stage, source, options, [&](std::span<const AcceptedJob> accepted) {
        for (const AcceptedJob& each : accepted) summaries.push_back(each.output.summary);
      });
    };
  }
};

}  // namespace meshfarm::test
