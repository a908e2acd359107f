// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>
#include <optional>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/clean_stage.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/pipeline/sink_need.hpp>
#include <meshfarm/transport/sink.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>
#include <meshfarm/util/stopwatch.hpp>

#include "cli/farm_command.hpp"
#include "cli/output_place.hpp"
#include "cli/output_words.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

class SinkCommand : public FarmCommand {
 public:
  std::string_view name() const override { return "sink"; }
  std::string_view synopsis() const override {
    return "STAGE -o OUTPUT (--ratio R | --triangles N | --error LENGTH)";
  }
  std::string_view summary() const override {
    return "collect, stitch and finish the parts of a stage ('run' starts this)";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    add_stage(options, positional);
    options.add_options()("output,o", po::value(&output_)->required()->value_name("FILE"),
                          "where the result goes: .ply, .glb, .gltf, .off, .obj or .stl");
    output_words_.add(options);
    target_.add(options);
    target_.add_attributes(options);
    network_.add(options);
    when_full_.add(options);
    options.add_options()("wait",
                          po::value(&wait_s_)->default_value(wait_s_)->value_name("SECONDS"),
                          "how long to look for a ventilator");
    talk_.add(options);
  }
  void check() override {
    target_.check();
    network_.check();
  }
  void check_given(const GivenOptions& given) const override {
    if (supervised()) return;  // the parent checked it
    target_.check_given(given);
    output_words_.check_given(given, output_);
  }

 protected:
  const SecurityWords& security() const override { return network_.security; }
  void serve(const Stage& stage, const std::atomic<bool>& stop) override {
    const Manifest manifest = read_manifest(stage);
    check_writable(output_);
    check_not_of_stage("-o", output_, stage.root().string());
    check_output_fits(output_, manifest, target_.run);
    check_need(manifest);
    if (!supervised()) tell_textures(manifest, target_.run);
    SinkOptions options;
    options.bind = network_.bind;
    options.first_port = network_.first_port;
    options.last_port = network_.last_port;
    options.security = network_.security.security;
    options.run = run_key(manifest, target_.run);
    options.algorithm = k_algorithm_version;
    options.inspect = check_output;
    options.patience = std::chrono::seconds(wait_s_);
    options.when_full = when_full_.value();
    options.stop = &stop;
    std::optional<SinkPresence> presence(stage);
    ProgressPrinter printer(talk_.progress());
    AssembleOptions assembly;
    assembly.output = {output_, output_words_.packing()};
    assembly.stop = &stop;
    assembly.progress = [&](std::string_view phase, double done, std::uint64_t made) {
      printer.show({.phase = phase, .done = done, .triangles = made});
    };
    Assembler assembler(stage, manifest, target_.run, assembly);
    Stopwatch watch;
    double farm_seconds = 0;
    options.do_here = [&](const Job& job, const JobContext& context,
                          std::span<const AcceptedJob> accepted) {
      farm_seconds += watch.lap();
      JobOutput output = assembler.do_job(job, context, accepted);
      printer.end();
      watch.lap();
      return output;
    };
    RunSummary summary;
    const std::uint32_t epoch = run_sink(stage, make_job_source(manifest, target_.run), options,
                                         [&](std::span<const AcceptedJob> accepted) {
                                           farm_seconds += watch.lap();
                                           summary = assembler.complete(accepted);
                                           printer.end();
                                         });
    summary.farm_seconds = farm_seconds;
    summary.run = options.run;
    summary.epoch = epoch;
    publish_summary(stage, summary);
    presence.reset();
    tidy_up(stage);
    std::cout << render(summary, talk_.format());
  }

 private:
  /// Removes leftovers in the stage that no run can need.
  static void tidy_up(const Stage& stage) {
    CleanOptions leftovers;
    leftovers.what = CleanWhat::leftovers;
    try {
      clean_stage(stage, leftovers);
    } catch (const Error& error) {
      log_debug(error.what());  // another process cleans up
    }
  }

  /// Checks before hours of farming, not after.
  void check_need(const Manifest& manifest) const {
    const auto room = available_memory();
    const std::string advice =
        check_sink_need(manifest, target_.run, room ? std::optional(room->bytes) : std::nullopt);
    if (!advice.empty()) log_warning(advice);
  }

  std::string output_;
  OutputWords output_words_;
  TargetOptions target_;
  NetworkOptions network_;
  FullWords when_full_;
  std::uint32_t wait_s_ = 60;
};

}  // namespace

std::unique_ptr<Command> make_sink_command() {
  return std::make_unique<SinkCommand>();
}

}  // namespace meshfarm
