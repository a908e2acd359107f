// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/text.hpp>

namespace meshfarm {
namespace {

/// Uses a clock that readers of the trace can also query.
double unix_seconds(const Stage& stage) {
  const std::filesystem::path folder = stage.path(TraceName{1}).parent_path();
  std::error_code ignored;
  std::filesystem::create_directory(folder, ignored);
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return server_unix_s(folder).value_or(std::chrono::duration<double>(since).count());
}

TraceLine line_of(const WorkerJoined& e, double t) {
  const Capacity& has = e.capacity;
  return TraceJoined{t,         e.worker.value, e.host,          e.pid,
                     has.speed, has.memory,     has.memory_pool, has.threads};
}

TraceLine line_of(const WorkerLeft& e, double t) {
  return TraceLeft{t, e.worker.value, e.why};
}

TraceLine line_of(const AttemptFailed& e, double t) {
  return TraceFailed{t, e.worker.value, e.key.value, e.reason};
}

TraceLine line_of(const JobAccepted& e, double t) {
  TraceDone line;
  line.t = t;
  line.worker = e.worker.value;
  line.job = e.key.value;
  line.kind = e.job.kind;
  line.stage = e.place.stage;
  line.index = e.place.index;
  for (const JobPlace::Need& each : e.place.needs) {
    line.needs.push_back({each.stage, each.first, each.count});
  }
  line.triangles = e.job.cost;
  line.memory = e.job.memory;
  line.read_bytes = e.job.reads + input_bytes(e.job);
  line.extent = e.job.extent.name;
  line.extent_bytes = e.job.extent.bytes;
  line.written_bytes = e.output_bytes;
  line.read_ms = e.times.read_ms;
  line.wait_ms = e.times.wait_ms;
  line.compute_ms = e.times.compute_ms;
  line.write_ms = e.times.write_ms;
  line.cpu_us = e.times.cpu_us;
  return line;
}

TraceState::Worker line_of(const WorkerStatus& w) {
  return {w.id.value, w.held,      static_cast<std::uint32_t>(w.room),
          w.speed,    w.rss_bytes, seconds(w.silent)};
}

}  // namespace

void RunTrace::follow(VentilatorOptions& options) {
  options.event = [this](const FarmEvent& each, FarmTime at) { event(each, at); };
  options.state = [this](const FarmProgress& progress, const std::vector<WorkerStatus>& workers,
                         FarmTime at) { state(progress, workers, at); };
}

void RunTrace::add(const TraceLine& line) {
  if (log_) log_->add(to_line(line));
}

void RunTrace::event(const FarmEvent& event, FarmTime at) {
  last_s_ = seconds(at);
  if (const auto* began = std::get_if<RunBegan>(&event)) {
    begin_ = std::chrono::steady_clock::now() - at;
    head_.epoch = began->epoch;
    head_.host = began->host;
    head_.unix_s = unix_seconds(stage_);
    log_ = std::make_unique<LineLog>(stage_.path(TraceName{began->epoch}));
    return add(head_);
  }
  std::visit(
      [&](const auto& each) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(each)>, RunBegan>) {
          add(line_of(each, last_s_));
        }
      },
      event);
}

void RunTrace::state(const FarmProgress& progress, const std::vector<WorkerStatus>& workers,
                     FarmTime at) {
  TraceState line;
  last_s_ = line.t = seconds(at);
  line.jobs_done = progress.jobs_done;
  line.jobs_running = progress.jobs_running;
  line.jobs_failed = progress.jobs_failed;
  line.jobs_known = progress.jobs_known;
  for (const StageProgress& each : progress.stages) {
    line.stages.push_back({each.stage, each.jobs, each.accepted});
  }
  line.retries = progress.retries;
  line.triangles_done = progress.cost_done;
  line.triangles_known = progress.cost_known;
  line.sink = progress.sink_present;
  line.storage_stalls = progress.storage_stalls;
  line.no_room = progress.no_room;
  line.bad_hosts = progress.bad_hosts;
  for (const WorkerStatus& worker : workers) line.workers.push_back(line_of(worker));
  add(line);
}

void RunTrace::end(const std::string& failure) {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begin_;
  add(TraceEnd{std::max(last_s_, since.count()), failure});
  log_.reset();
}

void publish_summary(const Stage& stage, const RunSummary& summary) {
  try {
    std::error_code ignored;
    std::filesystem::create_directory(stage.path(SummaryName{1}).parent_path(), ignored);
    const std::vector<std::uint32_t> numbers = stage.summaries();
    const SummaryName name{numbers.empty() ? 1 : numbers.back() + 1};
    stage.publish(name, render(summary, Format::json));
  } catch (const Error& error) {
    log_warning("the summary is not kept in the stage: " + std::string(error.what()));
  }
}

Trace read_newest_trace(const Stage& stage, std::optional<std::uint32_t> epoch) {
  const std::vector<std::uint32_t> traces = stage.traces();
  if (traces.empty()) {
    throw DataError(stage.root().string() + ": no run of this stage was traced yet");
  }
  if (epoch && std::find(traces.begin(), traces.end(), *epoch) == traces.end()) {
    std::vector<std::string> there;
    there.reserve(traces.size());
    for (const std::uint32_t each : traces) there.push_back(std::to_string(each));
    throw DataError(stage.root().string() + ": no run of epoch " + std::to_string(*epoch) +
                    " was traced; those of " + joined(there) + " were");
  }
  const TraceName name{epoch.value_or(traces.back())};
  return parse_trace(stage.read(name), stage.path(name).string());
}

Trace read_traced_run(const Stage& stage) {
  Trace run = read_newest_trace(stage);
  std::uint32_t workers = 0;
  for (const TraceJoined& each : run.joined) workers = std::max(workers, each.worker);
  std::vector<TraceDone> done;
  for (const std::uint32_t epoch : stage.traces()) {
    if (epoch >= run.head.epoch) continue;
    const Trace before = read_newest_trace(stage, epoch);
    if (before.head.run != run.head.run) continue;
    const std::uint32_t first = workers;
    for (const TraceJoined& each : before.joined) workers = std::max(workers, first + each.worker);
    for (TraceDone each : before.done) {
      if (each.worker != k_sink_of_trace) each.worker += first;
      done.push_back(each);
    }
  }
  run.done.insert(run.done.begin(), done.begin(), done.end());
  return run;
}

bool output_was_made(const Stage& stage, std::uint64_t run) {
  const std::optional<RunTimes> made = read_run_times(stage, run);
  if (!made || made->epoch == 0) return false;
  EndpointList endpoints;
  bool served = false;
  for (const Endpoint& each : endpoints.look(stage)) {
    if (each.run != run || each.epoch < made->epoch) continue;
    if (each.address.empty()) return false;
    served = served || each.epoch == made->epoch;
  }
  return served;
}

std::optional<RunTimes> read_run_times(const Stage& stage, std::uint64_t run) {
  const std::vector<std::uint32_t> numbers = stage.summaries();
  for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) {
    const SummaryName name{*number};
    const RunTimes times = parse_run_times(stage.read(name), stage.path(name).string());
    if (times.run == run) return times;
  }
  return std::nullopt;
}

}  // namespace meshfarm
