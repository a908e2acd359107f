// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/pool_worker.hpp"

#include <map>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <meshfarm/pipeline/pool.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds k_choose_every{300};
/// Within this time a run's trace shows that the run is served.
constexpr std::chrono::milliseconds k_until_seen{2000};
/// A run that is over for workers is not joined again until its trace says so...
constexpr std::chrono::seconds k_after_the_end{3};
/// ...and one whose ventilator does not answer gets time to come back.
constexpr std::chrono::seconds k_after_silence{30};

class PoolWorker {
 public:
  PoolWorker(const PoolWork& work, const std::atomic<bool>& stop) : work_(work), stop_(stop) {}

  void run() {
    Clock::time_point idle_since = Clock::now();
    while (!stop_) {
      if (const std::optional<PoolRun> run = choose()) {
        serve(*run);
        idle_since = Clock::now();
        continue;
      }
      if (work_.wait && Clock::now() - idle_since > *work_.wait) return;
      pause(k_choose_every);
    }
  }

 private:
  std::vector<PoolRun> candidates() const {
    std::vector<PoolRun> runs = runs_of_pool(work_.folder);
    std::erase_if(runs, [&](const PoolRun& run) {
      const auto found = left_alone_.find({run.stage, run.epoch});
      return found != left_alone_.end() && Clock::now() < found->second;
    });
    return runs;
  }

  /// Workers that arrive together would all choose the same run: each waits for a random time, and
  /// sees what the others chose.
  std::optional<PoolRun> choose() {
    const std::vector<PoolRun> runs = candidates();
    if (runs.size() < 2) return neediest(runs);
    std::uniform_int_distribution<int> upto(0, static_cast<int>(k_until_seen.count()));
    pause(std::chrono::milliseconds(upto(random_)));
    return stop_ ? std::nullopt : neediest(candidates());
  }

  void serve(const PoolRun& run) {
    Clock::duration alone = k_after_the_end;
    try {
      work_.serve(Stage::open(run.stage), run.run);
    } catch (const Error& error) {
      if (!stop_) log_warning(run.stage.string() + ": " + error.what() + "; looking on");
      alone = k_after_silence;
    }
    left_alone_[{run.stage, run.epoch}] = Clock::now() + alone;
  }

  void pause(std::chrono::milliseconds length) const {
    constexpr std::chrono::milliseconds k_step{50};
    const auto end = Clock::now() + length;
    while (!stop_ && Clock::now() < end) std::this_thread::sleep_for(k_step);
  }

  const PoolWork& work_;
  const std::atomic<bool>& stop_;
  std::map<std::pair<std::filesystem::path, std::uint32_t>, Clock::time_point> left_alone_;
  std::mt19937 random_{std::random_device{}()};
};

}  // namespace

void serve_pool(const PoolWork& work, const std::atomic<bool>& stop) {
  PoolWorker(work, stop).run();
}

}  // namespace meshfarm
