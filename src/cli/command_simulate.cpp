// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <iostream>

#include <meshfarm/farm/simulated_seeds.hpp>
#include <meshfarm/report/simulation_report.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class SimulateCommand : public Command {
 public:
  std::string_view name() const override { return "simulate"; }
  std::string_view synopsis() const override { return "(--seed N | --seeds COUNT)"; }
  std::string_view summary() const override {
    return "run the farm's own logic on virtual time, with faults";
  }
  void setup(po::options_description& options, po::positional_options_description&) override {
    options.add_options()("seed", po::value(&seed_)->value_name("N"),
                          "one history, or the first of --seeds");
    options.add_options()("seeds", po::value(&seeds_.count)->value_name("COUNT"),
                          "as many histories, each with its own mix of faults");
    options.add_options()(
        "workers", po::value(&seeds_.workers)->default_value(seeds_.workers)->value_name("N"),
        "simulated workers");
    options.add_options()("jobs",
                          po::value(&seeds_.jobs)->default_value(seeds_.jobs)->value_name("N"),
                          "simulated jobs");
    options.add_options()("threads", po::value(&seeds_.threads)->value_name("N"),
                          "simulate as many seeds at once (default: one a core)");
    talk_.add(options);
  }
  void check() override {
    if (seed_ == 0 && seeds_.count == 0) throw UsageError("give --seed N or --seeds COUNT");
    if (seed_ != 0) seeds_.first = seed_;
    if (seeds_.count == 0) seeds_.count = 1;
    if (seeds_.count > 10'000'000) throw UsageError("--seeds: at most 10000000");
    if (seeds_.workers == 0 || seeds_.workers > 100'000) {
      throw UsageError("--workers: from 1 to 100000");
    }
    if (seeds_.jobs < 16 || seeds_.jobs > 10'000'000) {
      throw UsageError("--jobs: from 16 to 10000000");
    }
  }
  int run() override {
    const auto start = std::chrono::steady_clock::now();
    const SeedsResult result = simulate_seeds(seeds_);
    SeedsSummary summary;
    summary.seeds = seeds_.count;
    summary.workers = seeds_.workers;
    summary.jobs = seeds_.jobs;
    summary.events = result.events;
    summary.virtual_s = result.virtual_s;
    summary.wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    summary.trace_hash = result.trace_hash;
    for (const SeedProblem& each : result.problems) {
      summary.problems.push_back({each.seed, each.what});
    }
    std::cout << render(summary, talk_.format());
    return summary.problems.empty() ? 0 : 1;
  }

 private:
  std::uint64_t seed_ = 0;
  SeedsOptions seeds_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command() {
  return std::make_unique<SimulateCommand>();
}

}  // namespace meshfarm
