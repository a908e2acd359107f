// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT

#include <string>
#include <string_view>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"
#include "cli/cut_record.hpp"
#include "cli/cut_step.hpp"
#include "cli/local_farm.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"
#include "cli/run_report.hpp"
#include "cli/signals.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

class SimplifyCommand : public Command {
 public:
  std::string_view name() const override { return "simplify"; }
  std::string_view synopsis() const override {
    return "INPUT -o OUTPUT (--ratio R | --triangles N | --error LENGTH)";
  }
  std::string_view summary() const override {
    return "simplify a mesh file on this machine: cut, farm, stitch, finish";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("input", po::value(&input_)->required(), "")(
        "output,o", po::value(&output_)->required()->value_name("FILE"),
        "where the result goes: .ply, .glb, .gltf, .off, .obj or .stl");
    output_words_.add(options);
    add_report(options, report_);
    target_.add(options);
    options.add_options()("workers", po::value(&workers_)->default_value(workers_)->value_name("N"),
                          "worker processes (default: cores)");
    cut_.add(options);
    target_.add_texture_size(options);
    options.add_options()("stage", po::value(&stage_)->value_name("FOLDER"),
                          "where parts are staged (default: OUTPUT.stage)")(
        "keep-stage", po::bool_switch(&keep_stage_), "keep the stage, for replay")(
        // Started by a batch, whose crew of workers serves this run.
        "in-batch", po::bool_switch(&in_batch_), "")("key-file",
                                                     po::value(&network_.security.key_file), "");
    when_full_.add(options);
    talk_.add(options);
    positional.add("input", 1);
  }
  void check() override {
    target_.attributes = cut_.attributes;
    const TextureWords textures = texture_words_for(output_, cut_.uv);
    cut_.uv = textures.cut;
    target_.uv = textures.run;
    target_.check();
    cut_.check();
    if (cut_.where == "farm") check_farmed_cut();
    if (in_batch_) workers_ = 0;
    if ((workers_ == 0 && !in_batch_) || workers_ > 1000)
      throw UsageError("--workers: from 1 to 1000");
    is_own_stage_ = stage_.empty() || in_batch_;
    if (stage_.empty()) stage_ = output_ + ".stage";
    network_.bind = "127.0.0.1";
    network_.this_host_only = true;
    network_.check();
  }
  void check_given(const GivenOptions& given) const override {
    if (in_batch_) return;  // the batch checked it already
    target_.check_given(given);
    cut_.check_given(given, true);
    output_words_.check_given(given, output_);
  }
  int run() override {
    const std::atomic<bool>& stop = stop_on_signals();
    check_not_over("-o", output_, "the input", input_);
    check_writable(output_);
    if (!report_.empty()) {
      check_not_over("--report", report_, "the input", input_);
      check_report(report_, output_, stage_);
    }
    check_not_of_stage("-o", output_, stage_);
    const Claim claim(claim_of(output_), output_ + ": is being made");
    remove_unfinished(output_);
    const bool stage_was_there = !is_own_stage_ && holds_cut(stage_);
    cut_to_stage({input_, stage_, cut_, talk_, stop,
                  [this](std::uint64_t triangles) { return farm_pays(triangles); },
                  target_.run.error});
    const int code = run_local_farm(
        {stage_, output_, output_words_, target_, network_, schedule_, when_full_, talk_, workers_},
        stop);
    if (code == 0 && !report_.empty()) write_run_report({stage_, report_, MadeBy::this_command});
    if (code == 0 && !keep_stage_) {
      if (stage_was_there) {
        log_info(stage_ + " is kept: it held the cut before");
      } else {
        remove_stage(stage_);
      }
    }
    if (code == 3) {
      log_info(
          "stopped; the parts are kept: to continue, run the same command again, or 'meshfarm "
          "replay " +
          stage_ + " -o " + output_ + "' with the same target");
    }
    return code;
  }

 private:
  /// Runs before a stage exists that would get in the way of a later command.
  void check_farmed_cut() const {
    constexpr std::string_view k_not_kept =
        "the parts of the input, which --cut farm does not keep: use --cut here";
    if (!report_.empty()) throw UsageError("--report shows " + std::string(k_not_kept));
  }

  /// Measured: from about five million triangles on, a cut by jobs takes no more processor time
  /// than a cut here, which uses all processors. Commands that look at parts later need a cut that
  /// keeps them, as does a result so large that it may be finished in pieces.
  bool farm_pays(std::uint64_t triangles) const {
    constexpr std::uint64_t k_worth_jobs = 5'000'000;
    constexpr double k_large_result = 5e6;
    const RunOptions& run = target_.run;
    const bool keeps_parts = keep_stage_ || in_batch_ || !report_.empty() || run.error.value > 0;
    if (keeps_parts || run.finish_place == FinishPlace::farm) return false;
    const double result = run.triangles != 0 ? static_cast<double>(run.triangles)
                                             : run.ratio * static_cast<double>(triangles);
    return triangles >= k_worth_jobs && result <= k_large_result &&
           2 * workers_ >= default_workers();
  }

  std::string input_;
  std::string output_;
  std::string stage_;
  bool is_own_stage_ = true;  // not one that a user may have made
  bool keep_stage_ = false;
  bool in_batch_ = false;
  std::uint32_t workers_ = default_workers();
  std::string report_;
  OutputWords output_words_;
  TargetOptions target_;
  CutWords cut_;
  NetworkOptions network_;
  ScheduleWords schedule_;
  FullWords when_full_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_simplify_command() {
  return std::make_unique<SimplifyCommand>();
}

}  // namespace meshfarm
