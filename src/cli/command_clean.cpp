// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/pipeline/clean_stage.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class CleanCommand : public Command {
 public:
  std::string_view name() const override { return "clean"; }
  std::string_view synopsis() const override { return "STAGE [--dry-run]"; }
  std::string_view summary() const override {
    return "remove files that no run needs from a stage: results of finished runs, leftovers of "
           "dead processes";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "dry-run", po::bool_switch(&dry_run_), "remove nothing, only say what would go")(
        "json", po::bool_switch(&json_), "print the result as JSON");
    positional.add("stage", 1);
  }
  int run() override {
    CleanOptions options;
    options.dry_run = dry_run_;
    std::cout << render(clean_stage(Stage::open(stage_), options),
                        json_ ? Format::json : Format::text);
    return 0;
  }

 private:
  std::string stage_;
  bool dry_run_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_clean_command() {
  return std::make_unique<CleanCommand>();
}

}  // namespace meshfarm
