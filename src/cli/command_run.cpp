// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"
#include "cli/local_farm.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"
#include "cli/run_report.hpp"
#include "cli/signals.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

/// `run` serves workers of any host; `replay` starts its own. Otherwise they are the same.
enum class Workers { of_any_host, own };

class RunCommand : public Command {
 public:
  explicit RunCommand(Workers whose)
      : whose_(whose), workers_(whose == Workers::own ? default_workers() : 0) {}
  std::string_view name() const override { return whose_ == Workers::own ? "replay" : "run"; }
  std::string_view synopsis() const override {
    return "STAGE [-o OUTPUT] (--ratio R | --triangles N | --error LENGTH)";
  }
  std::string_view summary() const override {
    return whose_ == Workers::own
               ? "simplify a stage on this machine, without cutting again"
               : "simplify a stage: start ventilator and sink, and let workers join";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "output,o", po::value(&output_)->value_name("FILE"),
        "where the result goes; .ply, .glb, .gltf, .off, .obj or .stl (default: STAGE/result.ply)");
    output_words_.add(options);
    add_report(options, report_);
    target_.add(options);
    target_.add_attributes(options);
    options.add_options()("workers", po::value(&workers_)->default_value(workers_)->value_name("N"),
                          whose_ == Workers::own ? "worker processes started here (default: cores)"
                                                 : "worker processes started here");
    if (whose_ == Workers::of_any_host) network_.add(options);
    schedule_.add(options);
    options.add_options()("worker-words", po::bool_switch(&worker_words_),
                          "only print the options with which to start each 'meshfarm worker STAGE' "
                          "of this run, one word per line");
    when_full_.add(options);
    talk_.add(options);
    positional.add("stage", 1);
  }
  void check() override {
    if (output_.empty()) output_ = (std::filesystem::path(stage_) / "result.ply").string();
    target_.uv = stage_uv_for(output_, target_.uv);
    target_.check();
    if (whose_ == Workers::own) {
      network_.bind = "127.0.0.1";
      network_.this_host_only = true;
      if (workers_ == 0) throw UsageError("--workers: from 1 to 1000");
    }
    if (workers_ > 1000) throw UsageError("--workers: at most 1000");
    network_.check();
    schedule_.check();
  }
  void check_given(const GivenOptions& given) const override {
    if (worker_words_) return;  // the run itself reports it
    target_.check_given(given);
    schedule_.check_given(given);
    output_words_.check_given(given, output_);
  }
  int run() override {
    if (worker_words_) return print_worker_words();
    const std::atomic<bool>& stop = stop_on_signals();
    check_writable(output_);
    check_not_of_stage("-o", output_, stage_);
    if (!report_.empty()) check_report(report_, output_, stage_);
    const Claim claim(claim_of(output_), output_ + ": is being made");
    remove_unfinished(output_);
    const int code = run_local_farm(
        {stage_, output_, output_words_, target_, network_, schedule_, when_full_, talk_, workers_},
        stop);
    if (code == 0 && !report_.empty()) write_run_report({stage_, report_, MadeBy::this_command});
    if (code == 3) {
      log_info("stopped; finished work is kept: run the same command again to continue");
    }
    return code;
  }

 private:
  int print_worker_words() const {
    const Stage stage = Stage::open(stage_);
    const Manifest manifest =
        decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
    std::cout << "--run\n" << to_hex(run_key(manifest, target_.run)) << "\n";
    for (const std::string& word : network_.security.words()) std::cout << word << "\n";
    return 0;
  }

  Workers whose_;
  bool worker_words_ = false;
  std::string stage_;
  std::string output_;
  std::uint32_t workers_;
  std::string report_;
  OutputWords output_words_;
  TargetOptions target_;
  NetworkOptions network_;
  ScheduleWords schedule_;
  FullWords when_full_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_run_command() {
  return std::make_unique<RunCommand>(Workers::of_any_host);
}

std::unique_ptr<Command> make_replay_command() {
  return std::make_unique<RunCommand>(Workers::own);
}

}  // namespace meshfarm
