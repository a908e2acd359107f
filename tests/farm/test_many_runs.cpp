// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Two runs and three replays of one stage at once, with workers of all kinds and random delays on
// every file: each must end with its own bytes. MESHFARM_ROUNDS=50 runs that many rounds; the
// default is a few, to be quick.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/transport/worker.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_run_ratios[] = {"0.03", "0.04"};
constexpr const char* k_replay_ratios[] = {"0.05", "0.06", "0.08"};
constexpr const char* k_longest_delay_ms = "300";

int rounds() {
  const char* wish = std::getenv("MESHFARM_ROUNDS");
  return wish == nullptr ? 2 : std::atoi(wish);
}

/// Delays every file below the stage, in processes started during its lifetime.
class Delays {
 public:
  explicit Delays(const std::string& below) {
    ::setenv("LD_PRELOAD", MESHFARM_FAULT_SHIM, 1);
    ::setenv("MESHFARM_FAULT_BELOW", below.c_str(), 1);
    ::setenv("MESHFARM_FAULT_DELAY_MS", k_longest_delay_ms, 1);
  }
  ~Delays() {
    for (const char* name : {"LD_PRELOAD", "MESHFARM_FAULT_BELOW", "MESHFARM_FAULT_DELAY_MS"}) {
      ::unsetenv(name);
    }
  }
};

/// A stage of 12 parts, and its undisturbed result at each of the ratios.
class Bench : public FarmBench {
 public:
  Bench() : FarmBench("60000"), cut_(cut({"--parts", "12"})) {
    for (const char* ratio : k_run_ratios) make(ratio);
    for (const char* ratio : k_replay_ratios) make(ratio);
  }

  std::string fresh_stage(int round) {
    const std::string stage = path("round" + std::to_string(round));
    fs::copy(cut_, stage, fs::copy_options::recursive);
    return stage;
  }
  void check(const std::string& output, const std::string& ratio) const {
    CHECK(read_text(output) == results_.at(ratio));
  }
  std::string key_of(const std::string& stage, const std::string& ratio) {
    const Ran words = meshfarm({"run", stage, "--ratio", ratio, "--worker-words"});
    REQUIRE(words.out.rfind("--run\n", 0) == 0);
    return words.out.substr(6, 16);
  }

 private:
  void make(const std::string& ratio) {
    const std::string stage = path("quiet" + ratio);
    fs::copy(cut_, stage, fs::copy_options::recursive);
    const std::string output = stage + ".ply";
    REQUIRE(meshfarm({"replay", stage, "--ratio", ratio, "-o", output, "-q"}).code == 0);
    results_[ratio] = read_text(output);
  }
  std::string cut_;
  std::map<std::string, std::string> results_;
};

Bench& bench() {
  static Bench instance;
  return instance;
}

/// The message with which a worker of another build refuses to serve.
std::string refusal_of_another_build(const std::string& stage) {
  WorkerOptions options;
  options.algorithm = k_algorithm_version + 96;
  options.patience = std::chrono::seconds(60);
  try {
    run_worker(Stage::open(stage), do_job, options);
  } catch (const IncompleteError& error) {
    return error.what();
  }
  return "";
}

struct Command {
  std::string name;
  std::vector<std::string> words;
  std::string output = {};  // empty for a worker
  std::string ratio = {};
};

std::vector<Command> commands_of_a_round(const std::string& stage, const std::string& pool) {
  std::vector<Command> all;
  for (const char* ratio : k_run_ratios) {
    const std::string output = stage + "-" + ratio + ".ply";
    all.push_back({"run",
                   {"run", stage, "--ratio", ratio, "-o", output, "--bind", "127.0.0.1", "-q"},
                   output,
                   ratio});
  }
  for (const char* ratio : k_replay_ratios) {
    const std::string output = stage + "-" + ratio + ".ply";
    all.push_back({"replay",
                   {"replay", stage, "--ratio", ratio, "-o", output, "--workers", "1", "-q"},
                   output,
                   ratio});
  }
  all.push_back({"worker of a run",
                 {"worker", stage, "--run", bench().key_of(stage, k_run_ratios[0]), "-q"}});
  all.push_back({"worker of any run", {"worker", stage, "-q"}});
  all.push_back({"worker of several threads", {"worker", stage, "--threads", "2", "-q"}});
  all.push_back({"worker of a pool", {"worker", "--pool", pool, "-q"}});
  return all;
}

void play_round(int round) {
  CAPTURE(round);
  std::mt19937 random(static_cast<unsigned>(round));
  const std::string stage = bench().fresh_stage(round);
  const std::string pool = bench().path("pool" + std::to_string(round));
  fs::create_directory(pool);
  fs::create_directory_symlink(stage, fs::path(pool) / "one");
  std::vector<Command> commands = commands_of_a_round(stage, pool);
  std::shuffle(commands.begin(), commands.end(), random);
  std::vector<Process> processes;
  {
    const Delays delays(stage);
    for (const Command& each : commands) {
      processes.push_back(bench().start(each.words));
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 200));
    }
  }
  const std::string refusal = refusal_of_another_build(stage);
  CHECK(refusal.find("version " + std::to_string(k_algorithm_version)) != std::string::npos);
  CHECK(refusal.find("version " + std::to_string(k_algorithm_version + 96)) != std::string::npos);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].output.empty()) continue;
    CAPTURE(commands[i].name);
    CAPTURE(commands[i].ratio);
    CHECK(processes[i].wait() == 0);
    CAPTURE(processes[i].err());
    bench().check(commands[i].output, commands[i].ratio);
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].output.empty()) continue;
    CAPTURE(commands[i].name);
    if (commands[i].name == "worker of a pool") processes[i].signal(SIGTERM);  // it waits for more
    const int code = processes[i].wait(90);
    const std::string said = processes[i].err();
    CAPTURE(said);
    // Other workers may have finished its run before it was admitted.
    const bool late = code == 3 && said.find("over") != std::string::npos;
    CHECK((code == 0 || late));
  }
  fs::remove_all(stage);
}

}  // namespace

TEST_CASE("two runs and three replays of one stage at once each end with their own bytes") {
  for (int round = 1; round <= rounds(); ++round) play_round(round);
}

}  // namespace meshfarm::test
