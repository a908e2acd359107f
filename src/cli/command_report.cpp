// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <optional>

#include "cli/command.hpp"
#include "cli/output_place.hpp"
#include "cli/run_report.hpp"
#include "cli/view_words.hpp"

namespace meshfarm {
namespace {

class ReportCommand : public Command {
 public:
  std::string_view name() const override { return "report"; }
  std::string_view synopsis() const override { return "STAGE [-o FILE]"; }
  std::string_view summary() const override {
    return "a page about a stage's run: pictures, errors, figures, and where the time went";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "output,o", po::value(&output_)->value_name("FILE"),
        "where the page goes, as HTML (default: STAGE/report.html)")(
        "epoch", po::value(&epoch_)->value_name("N"),
        "the run of this epoch (0, the default: the last)")(
        "up", po::value(&up_)->value_name("x|y|z|-x|-y|-z"),
        "the mesh's axis that points up (default: y, or z if the mesh is flat along z)");
    positional.add("stage", 1);
  }
  void check() override {
    if (!up_.empty()) parse_up(up_);
    if (output_.empty()) output_ = stage_ + "/report.html";
  }
  int run() override {
    check_place(output_);
    check_not_of_stage("-o", output_, stage_);
    RunReport report{stage_, output_, MadeBy::another};
    if (epoch_ != 0) report.epoch = epoch_;
    if (!up_.empty()) report.up = parse_up(up_);
    write_run_report(report);
    return 0;
  }

 private:
  std::string stage_;
  std::string output_;
  std::uint32_t epoch_ = 0;
  std::string up_;
};

}  // namespace

std::unique_ptr<Command> make_report_command() {
  return std::make_unique<ReportCommand>();
}

}  // namespace meshfarm
