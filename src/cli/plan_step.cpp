// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/plan_step.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>

#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/output_place.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_workers = 100'000;

/// The paper's clusters: 24 PCs, and 16 of them with 8 at a third of their speed.
const std::vector<WorkerGroup> k_equal_pcs = {{24, 1}};
const std::vector<WorkerGroup> k_mixed_pcs = {{16, 1}, {8, 1.0 / 3}};
constexpr std::uint64_t k_fewest_jobs = 128;
constexpr std::uint64_t k_most_jobs = 4096;

/// `typed` is for the message.
double number_in(const std::string& text, std::string_view option, const std::string& typed) {
  double value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc{} || end != last || !(value > 0) || value > 1e9) {
    throw UsageError(std::string(option) + ": '" + typed + "' is no number above 0");
  }
  return value;
}

/// "24" or "16x1+8x0.333".
std::vector<WorkerGroup> groups_in(const std::string& text) {
  std::vector<WorkerGroup> groups;
  std::istringstream words(text);
  std::uint64_t all = 0;
  for (std::string word; std::getline(words, word, '+');) {
    const std::size_t times = word.find('x');
    const double count = number_in(word.substr(0, times), "--workers", word);
    WorkerGroup group{static_cast<std::uint64_t>(count), 1};
    if (times != std::string::npos)
      group.speed = number_in(word.substr(times + 1), "--workers", word);
    all += group.count;
    groups.push_back(group);
  }
  if (all == 0 || all > k_most_workers) throw UsageError("--workers: from 1 to 100000");
  return groups;
}

/// A stage's newest trace, or a trace file.
struct Past {
  Trace trace;
  std::optional<RunTimes> times;
};

Past read_past(const std::string& path) {
  Past past;
  if (std::filesystem::is_directory(path)) {
    const Stage stage = Stage::open(path);
    past.trace = read_traced_run(stage);
    past.times = read_run_times(stage, past.trace.head.run);
  } else {
    past.trace = parse_trace(read_file(path), path);
  }
  return past;
}

}  // namespace

void PlanWords::add(po::options_description& options) {
  options.add_options()("stage", po::value(&stages), "");
  options.add_options()("parts", po::value(&parts)->value_name("N"),
                        "plan for the mesh cut into this many parts");
  options.add_options()("schedule",
                        po::value(&schedule)->default_value(schedule)->value_name("dynamic|static"),
                        "dynamic: each job goes to the worker that is expected to finish it first; "
                        "static: jobs are dealt out beforehand");
  options.add_options()("storage", po::value(&storage)->default_value(storage)->value_name("GBIT"),
                        "Gbit/s of the shared folder's server");
  options.add_options()("link", po::value(&link)->default_value(link)->value_name("GBIT"),
                        "Gbit/s of each host");
  options.add_options()("cache", po::value(&cache)->default_value(cache)->value_name("SIZE"),
                        "memory in which a host keeps what it has read and written (0: none)");
  options.add_options()("delay",
                        po::value(&delay_ms)->default_value(delay_ms, "0.1")->value_name("MS"),
                        "delay of a message in milliseconds");
  options.add_options()("limits", po::bool_switch(&limits),
                        "for each farm: what each stage takes, and what limits it");
  options.add_options()("paper", po::bool_switch(&paper),
                        "the paper's tables 1 or 2 and figure 4 (-o FILE: as SVG)");
  options.add_options()("off", po::value(&off)->default_value(off, "0.2")->value_name("SHARE"),
                        "figure 4: how far the workers' speeds are off those they reported");
  options.add_options()("output,o", po::value(&output)->value_name("FILE"),
                        "figure 4 as a picture, SVG");
}

void PlanWords::check() {
  std::istringstream words(workers);
  for (std::string word; std::getline(words, word, ',');) farms_.push_back({word, groups_in(word)});
  if (farms_.empty()) throw UsageError("--workers: none");
  if (schedule != "dynamic" && schedule != "static") {
    throw UsageError("--schedule: dynamic or static");
  }
  if (parts > 10'000'000) throw UsageError("--parts: at most 10000000");
  if (!(delay_ms >= 0) || delay_ms > 1e6) throw UsageError("--delay: from 0 to 1000000");
  if (!(off >= 0) || off >= 1) throw UsageError("--off: from 0 to 1");
  like_.schedule = schedule == "static" ? Schedule::fixed : Schedule::dynamic;
  like_.server_bytes_per_s = number_in(storage, "--storage", storage) * 1e9 / 8;
  like_.link_bytes_per_s = number_in(link, "--link", link) * 1e9 / 8;
  like_.cache_bytes = static_cast<double>(parse_size(cache, "--cache"));
  like_.delay_s = delay_ms * 1e-3;
}

void PlanWords::check_given(const GivenOptions& given) const {
  if (!paper && given.contains("output")) throw UsageError("-o needs --paper");
  if (!paper) warn_of_unused(given, {"off"}, "--paper");
  if (paper && given.contains("workers")) {
    log_warning("--workers changes nothing: --paper has farms of its own");
  }
}

PlannedFarm PlanWords::farm_of(const Farm& farm) const {
  PlannedFarm planned = like_;
  planned.groups = farm.groups;
  return planned;
}

PlanSummary PlanWords::plan_of(const std::string& stage, const std::vector<Farm>& farms) const {
  const Past past = read_past(stage);
  std::vector<PlannedJob> jobs = planned_jobs(past.trace);
  if (parts != 0) jobs = as_parts(jobs, parts);
  PlanSummary plan;
  plan.stage = stage;
  const bool swept = std::any_of(past.trace.done.begin(), past.trace.done.end(),
                                 [](const TraceDone& each) { return each.kind == k_sweep_kind; });
  plan.scheme = swept ? "stream" : "cut";
  plan.triangles_in = past.trace.head.triangles;
  plan.jobs = jobs.size();
  plan.schedule = schedule;
  plan.cut_s = past.trace.head.cut_s;
  if (past.times) {
    const RunTimes& times = *past.times;
    plan.triangles_out = times.triangles_out;
    plan.assemble_s = times.stitch + times.finish + times.measure + times.write;
  }
  plan.one_s = simulate_run(jobs, farm_of({"1", {{1, 1}}})).farm_s;
  for (const Farm& farm : farms) {
    const PlannedRun run = simulate_run(jobs, farm_of(farm));
    plan.lines.push_back(
        {farm.name, run.farm_s, run.ideal_s, plan.one_s / run.farm_s, run.storage_busy, {}});
    if (!limits) continue;
    for (PlannedStage& each : simulate_stages(jobs, farm_of(farm))) {
      plan.lines.back().stages.push_back({std::move(each.name), each.jobs, each.takes_s,
                                          each.ideal_s, each.longest_s, each.storage_s});
    }
  }
  return plan;
}

ScheduleComparison PlanWords::compare_schedules(const std::string& stage) const {
  const std::vector<PlannedJob> jobs = planned_jobs(read_past(stage).trace);
  ScheduleComparison comparison;
  comparison.farm = "16 fast and 8 slow";
  comparison.off = off;
  for (std::uint64_t count = k_fewest_jobs; count <= k_most_jobs; count *= 2) {
    const std::vector<PlannedJob> sample = drawn(jobs, count, 1);
    PlannedFarm farm = farm_of({"", k_mixed_pcs});
    PlannedFarm farm_off = farm;
    farm_off.off = off;
    farm.schedule = farm_off.schedule = Schedule::dynamic;
    const PlannedRun dynamic = simulate_run(sample, farm);
    const PlannedRun off_dynamic = simulate_run(sample, farm_off);
    farm.schedule = farm_off.schedule = Schedule::fixed;
    comparison.lines.push_back({count, dynamic.ideal_s, dynamic.farm_s,
                                simulate_run(sample, farm).farm_s, off_dynamic.ideal_s,
                                off_dynamic.farm_s, simulate_run(sample, farm_off).farm_s});
  }
  return comparison;
}

void PlanWords::run(Format format) const {
  if (paper && !output.empty()) {
    check_place(output);
    for (const std::string& stage : stages) {
      check_not_over("-o", output, "the trace", stage);
      check_not_of_stage("-o", output, stage);
    }
  }
  if (!paper) {
    for (const std::string& stage : stages) {
      std::cout << render(plan_of(stage, farms_), format) << "\n";
    }
    return;
  }
  std::vector<PlanSummary> plans;
  for (const std::string& stage : stages) plans.push_back(plan_of(stage, {{"24", k_equal_pcs}}));
  const ScheduleComparison comparison = compare_schedules(stages.front());
  if (format == Format::json) {
    for (const PlanSummary& plan : plans) std::cout << render(plan, format);
  } else {
    std::cout << render_paper_table(plans) << "\n";
  }
  std::cout << render(comparison, format);
  if (output.empty()) return;
  AtomicFile file(output);
  file.write(draw(comparison));
  file.commit();
  log_info("wrote " + output);
}

}  // namespace meshfarm
