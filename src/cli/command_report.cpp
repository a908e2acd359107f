// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <optional>

#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/report/timeline.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"

namespace meshfarm {
namespace {

class ReportCommand : public Command {
 public:
  std::string_view name() const override { return "report"; }
  std::string_view synopsis() const override { return "STAGE [-o FILE]"; }
  std::string_view summary() const override {
    return "a page with the timeline of a stage's run: who computed when";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "output,o", po::value(&output_)->value_name("FILE"),
        "where the page goes, as HTML (default: STAGE/report.html)")(
        "epoch", po::value(&epoch_)->value_name("N"), "the run of this epoch (default: the last)");
    positional.add("stage", 1);
  }
  void check() override {
    if (output_.empty()) output_ = stage_ + "/report.html";
  }
  int run() override {
    const Stage stage = Stage::open(stage_);
    const Manifest manifest =
        decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
    std::optional<std::uint32_t> epoch;
    if (epoch_ != 0) epoch = epoch_;
    const Trace trace = read_newest_trace(stage, epoch);
    AtomicFile file(output_);
    file.write(render_run_page(manifest, trace, read_run_times(stage, trace.head.run)));
    file.commit();
    log_info("wrote " + output_);
    return 0;
  }

 private:
  std::string stage_;
  std::string output_;
  std::uint32_t epoch_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_report_command() {
  return std::make_unique<ReportCommand>();
}

}  // namespace meshfarm
