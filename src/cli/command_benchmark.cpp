// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/pipeline/benchmark.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/memory.hpp>

#include "cli/command.hpp"
#include "cli/local_farm.hpp"
#include "cli/options.hpp"
#include "cli/version.hpp"

namespace meshfarm {
namespace {

class BenchmarkCommand : public Command {
 public:
  std::string_view name() const override { return "benchmark"; }
  std::string_view synopsis() const override { return ""; }
  std::string_view summary() const override {
    return "measure how fast this host simplifies; its workers remember it";
  }
  void setup(po::options_description& options, po::positional_options_description&) override {
    options.add_options()("json", po::bool_switch(&json_), "print the result as JSON");
  }
  int run() override {
    HostSummary host;
    host.speed = measure_speed();
    if (const auto room = available_memory()) host.memory = room->bytes;
    host.cores = default_workers();
    remember_speed(speed_folder(), speed_key(k_version), host.speed);
    std::cout << render(host, json_ ? Format::json : Format::text);
    return 0;
  }

 private:
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_benchmark_command() {
  return std::make_unique<BenchmarkCommand>();
}

}  // namespace meshfarm
