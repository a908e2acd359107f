// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <charconv>
#include <chrono>
#include <iostream>

#include <meshfarm/report/simulation_report.hpp>
#include <meshfarm/simulation/simulated_seeds.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/plan_step.hpp"

namespace meshfarm {
namespace {

class SimulateCommand : public Command {
 public:
  std::string_view name() const override { return "simulate"; }
  std::string_view synopsis() const override { return "STAGE... | --seed N | --seeds COUNT"; }
  std::string_view summary() const override {
    return "plan a farm from the trace of a run, or test the farm with faults, on virtual time";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("workers", po::value(&workers_)->value_name("LIST"),
                          "farms to plan, for example 24,240 or 16x1+8x0.33 (count x speed; "
                          "default: 24,240,10000); with --seeds one number (default: 24)");
    plan_.add(options);
    options.add_options()("seeds", po::value(&seeds_.count)->value_name("COUNT"),
                          "number of histories to try, each with its own mix of faults");
    options.add_options()("seed", po::value(&seed_)->value_name("N"),
                          "try this history; with --seeds: begin with it");
    options.add_options()("jobs",
                          po::value(&seeds_.jobs)->default_value(seeds_.jobs)->value_name("N"),
                          "with --seeds: jobs in each history");
    options.add_options()(
        "graph", po::value(&graph_)->default_value(graph_)->value_name("WHICH"),
        "with --seeds: 'run', the jobs of a whole run, cut and finish included, or "
        "'stages', three stages");
    options.add_options()("threads", po::value(&seeds_.threads)->value_name("N"),
                          "with --seeds: histories tried at once (0, the default: one a core)");
    talk_.add(options);
    positional.add("stage", -1);
  }
  void check() override {
    plans_ = !plan_.stages.empty();
    if (plans_ == (seed_ != 0 || seeds_.count != 0)) {
      throw UsageError("give a STAGE with a traced run, or --seed N or --seeds COUNT");
    }
    if (plans_) {
      if (!workers_.empty()) plan_.workers = workers_;
      plan_.check();
    } else {
      check_seeds();
    }
  }
  void check_given(const GivenOptions& given) const override {
    if (plans_) {
      warn_of_unused(given, {"jobs", "graph", "threads"}, "--seed or --seeds");
      plan_.check_given(given);
      return;
    }
    if (given.contains("output")) throw UsageError("-o needs a STAGE and --paper");
    warn_of_unused(
        given, {"parts", "schedule", "storage", "link", "cache", "delay", "limits", "paper", "off"},
        "a STAGE");
  }
  bool keeps_freed_memory() const override { return false; }
  int run() override {
    if (!plans_) return run_seeds();
    plan_.run(talk_.format());
    return 0;
  }

 private:
  void check_seeds() {
    if (graph_ != "run" && graph_ != "stages") throw UsageError("--graph: run or stages");
    seeds_.graph = graph_ == "run" ? SimulatedGraph::whole_run : SimulatedGraph::few_stages;
    if (seed_ != 0) seeds_.first = seed_;
    if (seeds_.count == 0) seeds_.count = 1;
    if (seeds_.count > 10'000'000) throw UsageError("--seeds: at most 10000000");
    if (!workers_.empty()) {
      const char* last = workers_.data() + workers_.size();
      const auto [end, error] = std::from_chars(workers_.data(), last, seeds_.workers);
      if (error != std::errc{} || end != last) seeds_.workers = 0;
    }
    if (seeds_.workers == 0 || seeds_.workers > 100'000) {
      throw UsageError("--workers: from 1 to 100000");
    }
    if (seeds_.jobs < 16 || seeds_.jobs > 10'000'000) {
      throw UsageError("--jobs: from 16 to 10000000");
    }
  }

  int run_seeds() const {
    const auto start = std::chrono::steady_clock::now();
    const SeedsResult result = simulate_seeds(seeds_);
    SeedsSummary summary;
    summary.seeds = seeds_.count;
    summary.workers = seeds_.workers;
    summary.jobs = seeds_.jobs;
    summary.graph = graph_;
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

  bool plans_ = false;
  std::string workers_;
  std::uint64_t seed_ = 0;
  std::string graph_ = "run";
  SeedsOptions seeds_;
  PlanWords plan_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command() {
  return std::make_unique<SimulateCommand>();
}

}  // namespace meshfarm
