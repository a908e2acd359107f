// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/report/summary.hpp>

#include "cli/command.hpp"
#include "cli/cut_step.hpp"
#include "cli/options.hpp"
#include "cli/signals.hpp"

namespace meshfarm {
namespace {

class CutCommand : public Command {
 public:
  std::string_view name() const override { return "cut"; }
  std::string_view synopsis() const override { return "INPUT --stage FOLDER"; }
  std::string_view summary() const override {
    return "cut a mesh file into parts in a shared folder, once for many runs";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("input", po::value(&input_)->required(), "")(
        "stage", po::value(&stage_)->required()->value_name("FOLDER"), "the stage to make");
    cut_.add(options);
    talk_.add(options);
    positional.add("input", 1);
  }
  void check() override { cut_.check(); }
  int run() override {
    const Manifest manifest = cut_to_stage({input_, stage_, cut_, talk_, stop_on_signals()});
    std::cout << render(manifest, stage_, talk_.format());
    return 0;
  }
  void check_given(const GivenOptions& given) const override { cut_.check_given(given, false); }

 private:
  std::string input_;
  std::string stage_;
  CutWords cut_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_cut_command() {
  return std::make_unique<CutCommand>();
}

}  // namespace meshfarm
