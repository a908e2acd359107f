// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/transport/ventilator.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/farm_command.hpp"

namespace meshfarm {
namespace {

class VentilatorCommand : public FarmCommand {
 public:
  std::string_view name() const override { return "ventilator"; }
  std::string_view synopsis() const override {
    return "STAGE (--ratio R | --triangles N | --error LENGTH)";
  }
  std::string_view summary() const override {
    return "hand the parts of a stage to workers ('run' starts this)";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    add_stage(options, positional);
    target_.add(options);
    target_.add_attributes(options);
    network_.add(options);
    schedule_.add(options);
    when_full_.add(options);
    options.add_options()("heartbeat-ms",
                          po::value(&heartbeat_ms_)->default_value(heartbeat_ms_)->value_name("N"),
                          "interval of heartbeats in milliseconds; a worker or sink that is silent "
                          "for three intervals is lost");
    options.add_options()(
        "wait", po::value(&wait_s_)->default_value(wait_s_)->value_name("SECONDS"),
        "how long to look for a sink if the output was made before, and to wait for "
        "a worker that has the memory for what is left");
    talk_.add_quiet(options);
  }
  void check() override {
    target_.check();
    network_.check();
    schedule_.check();
    if (heartbeat_ms_ < 50 || heartbeat_ms_ > 60'000) {
      throw UsageError("--heartbeat-ms: from 50 to 60000");
    }
  }
  void check_given(const GivenOptions& given) const override {
    if (supervised()) return;  // the parent checked it
    target_.check_given(given);
    schedule_.check_given(given);
  }

 protected:
  const SecurityWords& security() const override { return network_.security; }
  void serve(const Stage& stage, const std::atomic<bool>& stop) override {
    const Manifest manifest = read_manifest(stage);
    ProgressPrinter printer(talk_.progress());
    VentilatorOptions options;
    options.bind = network_.bind;
    options.first_port = network_.first_port;
    options.last_port = network_.last_port;
    options.security = network_.security.security;
    options.run = run_key(manifest, target_.run);
    options.algorithm = k_algorithm_version;
    options.heartbeat = std::chrono::milliseconds(heartbeat_ms_);
    options.hang = std::chrono::seconds(schedule_.hang_s);
    options.schedule = schedule_.options;
    options.when_full = when_full_.value();
    options.stop = &stop;
    options.patience = std::chrono::seconds(wait_s_);
    options.was_completed = [&, run = options.run] { return was_completed(stage, run); };
    options.progress = [&](const FarmProgress& p) { show(printer, p); };
    options.ended = [&](bool sink_was_told) { sink_was_told_ = sink_was_told; };
    TraceHead head;
    head.run = options.run;
    head.heartbeat_ms = heartbeat_ms_;
    head.schedule = schedule_.options.schedule == Schedule::fixed ? "static" : "dynamic";
    head.triangles = manifest.triangles();
    head.cut_s = manifest.cut_seconds;
    RunTrace trace(stage, head);
    trace.follow(options);
    try {
      run_ventilator(stage, make_job_source(manifest, target_.run), options);
    } catch (const Error& error) {
      trace.end(error.what());
      throw;
    }
    trace.end({});
  }

  bool sink_reports_failures() const override { return sink_was_told_; }

 private:
  static bool was_completed(const Stage& stage, std::uint64_t run) {
    if (!output_was_made(stage, run)) return false;
    log_info("no sink comes, for this run's output was made while no ventilator was there");
    return true;
  }

  /// The first stage that is not done.
  static StageProgress stage_of(const FarmProgress& p) {
    for (const StageProgress& each : p.stages) {
      if (each.accepted < each.jobs) return each;
    }
    return {"farm", p.jobs_known, p.jobs_done};
  }

  static void show(ProgressPrinter& printer, const FarmProgress& p) {
    if (p.jobs_done == p.jobs_known) return printer.end();
    const StageProgress stage = stage_of(p);
    std::string phase = stage.stage + ", " + std::to_string(stage.accepted) + " of " +
                        std::to_string(stage.jobs) + " jobs, ";
    if (p.workers == 0) {
      phase += "waiting for workers ('meshfarm worker STAGE' on any host)";
    } else {
      phase += std::to_string(p.workers) + (p.workers == 1 ? " worker" : " workers");
    }
    if (p.retries > 0) phase += ", " + std::to_string(p.retries) + " given out again";
    if (p.jobs_too_big > 0) {
      phase += ", " + std::to_string(p.jobs_too_big) + " wait for a worker with more memory";
    }
    for (const std::string& host : p.bad_hosts) phase += ", no more jobs for " + host;
    if (p.no_room) phase += ", no room on the stage, waiting";
    if (p.storage_stalls) phase += ", the stage's storage stands still";
    if (!p.other_build.empty()) phase += ", refused: " + p.other_build;
    if (p.refused > 0) phase += ", " + std::to_string(p.refused) + " strangers refused";
    const double all = static_cast<double>(std::max<std::uint64_t>(1, p.cost_known));
    printer.show(
        {.phase = phase, .done = static_cast<double>(p.cost_done) / all, .triangles = p.cost_done});
  }

  TargetOptions target_;
  NetworkOptions network_;
  ScheduleWords schedule_;
  FullWords when_full_;
  bool sink_was_told_ = false;
  std::uint32_t heartbeat_ms_ = 1000;
  std::uint32_t wait_s_ = 60;
};

}  // namespace

std::unique_ptr<Command> make_ventilator_command() {
  return std::make_unique<VentilatorCommand>();
}

}  // namespace meshfarm
