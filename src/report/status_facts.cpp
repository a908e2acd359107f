// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <unordered_map>
#include <utility>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/status.hpp>

namespace meshfarm {
namespace {

/// A ventilator writes at least every second, or as soon as its disk lets it: after this long
/// without a line it is dead or cut off.
constexpr double k_silent_s = 15;
/// After this long it may be worth finding out why.
constexpr double k_quiet_s = 3;
/// The rate is measured over this many recent seconds, if they contain jobs.
constexpr double k_rate_window_s = 60;

double last_time(const Trace& trace) {
  double t = trace.state ? trace.state->t : 0;
  if (!trace.done.empty()) t = std::max(t, trace.done.back().t);
  if (trace.end) t = std::max(t, trace.end->t);
  return t;
}

/// Seconds since the trace's last line; 0 if unknown, or if that was the end.
double age_of(const StageStatus& status) {
  const Trace& trace = *status.trace;
  if (trace.end || !status.now_unix_s) return 0;
  return std::max(0.0, *status.now_unix_s - trace.head.unix_s - last_time(trace));
}

/// The description of a running run, whether it makes progress, and whether somebody must act.
struct LivePhase {
  std::string words;
  bool works = false;
  bool warns = false;
};

LivePhase phase_while_full(double age_s) {
  std::string words = "no room on the stage, waiting";
  if (age_s > k_silent_s) {
    words += "; the ventilator, if it lives, could write nothing for " + duration_text(age_s);
  }
  return {words, false, true};
}

/// The phase while the ventilator writes.
LivePhase phase_heard(const TraceState& state) {
  if (!state.sink) return {"waiting for the sink"};
  const bool farmed = state.jobs_known > 0 && state.jobs_done == state.jobs_known;
  if (state.no_room) {
    return {farmed ? "no room for the result, waiting" : "no room on the stage, waiting", false,
            true};
  }
  if (farmed) return {"stitching and finishing"};
  if (state.storage_stalls) return {"waiting for the storage, which stalls", false, true};
  if (state.workers.empty()) {
    return {"waiting for workers ('meshfarm worker STAGE' on any host)", false, true};
  }
  return {"simplifying", true};
}

LivePhase phase_of(const TraceState& state, double age_s, bool age_is_known) {
  if (age_s > k_silent_s) {
    return {"no word from the ventilator for " + duration_text(age_s) +
                " (killed, cut off, or its storage stalls)",
            false, true};
  }
  LivePhase phase = phase_heard(state);
  if (age_is_known && age_s <= k_quiet_s) return phase;
  phase.words += age_is_known ? " when last heard of, " + duration_text(age_s) + " ago"
                              : " when last heard of, at an unknown time";
  phase.works = false;
  return phase;
}

void name_phase(const StageStatus& status, StatusFacts& facts) {
  if (status.trace->end) {
    const std::string& failure = status.trace->end->failure;
    facts.phase = failure.empty() ? "done" : "stopped: " + failure;
    facts.warns = !failure.empty();
    return;
  }
  const LivePhase phase = status.no_room
                              ? phase_while_full(facts.age_s)
                              : phase_of(facts.state, facts.age_s, status.now_unix_s.has_value());
  facts.phase = phase.words;
  facts.works = phase.works;
  facts.warns = phase.warns;
}

/// Triangles per second, from recently completed jobs.
double rate_of(const Trace& trace, double now) {
  double triangles = 0;
  double since = now;
  for (auto job = trace.done.rbegin(); job != trace.done.rend(); ++job) {
    if (job->t < now - k_rate_window_s) break;
    triangles += static_cast<double>(job->triangles);
    since = std::min(since, job->t - job->compute_ms / 1000.0);
  }
  return now > since ? triangles / (now - since) : 0;
}

void add_workers(const Trace& trace, StatusFacts& facts) {
  std::unordered_map<std::uint32_t, WorkerFacts> known;
  for (const TraceState::Worker& each : facts.state.workers) known[each.worker].state = each;
  const auto find = [&](std::uint32_t worker) -> WorkerFacts* {
    const auto found = known.find(worker);
    return found == known.end() ? nullptr : &found->second;
  };
  for (const TraceJoined& each : trace.joined) {
    if (WorkerFacts* const worker = find(each.worker)) worker->joined = each;
  }
  for (const TraceDone& each : trace.done) {
    if (WorkerFacts* const worker = find(each.worker)) ++worker->done;
  }
  for (const TraceFailed& each : trace.failed) {
    if (WorkerFacts* const worker = find(each.worker)) ++worker->failed;
  }
  for (const TraceState::Worker& each : facts.state.workers) {
    facts.workers.push_back(known[each.worker]);
    facts.workers.back().state.silent_s += facts.age_s;
  }
  facts.workers_left = trace.left.size();
}

}  // namespace

StatusFacts facts_of(const StageStatus& status) {
  StatusFacts facts;
  facts.stage = status.stage;
  facts.input = status.manifest.input;
  facts.triangles = status.manifest.triangles();
  facts.parts = status.manifest.part_count();
  facts.cut_s = status.manifest.cut_seconds;
  facts.free_bytes = status.free_bytes;
  if (!status.trace) {
    facts.phase = status.manifest.cutting ? "none yet; the first run will cut the mesh"
                                          : "none yet; the cut is whole";
    return facts;
  }
  const Trace& trace = *status.trace;
  facts.has_run = true;
  facts.head = trace.head;
  facts.over = is_over(status);
  facts.state = trace.state.value_or(TraceState{});
  facts.state.no_room = facts.state.no_room || status.no_room;
  facts.age_s = age_of(status);
  facts.elapsed_s = last_time(trace) + facts.age_s;
  name_phase(status, facts);
  const TraceState& s = facts.state;
  facts.rate = facts.works ? rate_of(trace, last_time(trace)) : 0;
  if (facts.rate > 0 && s.triangles_known > s.triangles_done) {
    facts.eta_s = static_cast<double>(s.triangles_known - s.triangles_done) / facts.rate;
  }
  add_workers(trace, facts);
  facts.times = status.times;
  return facts;
}

StatusFacts grown_older(StatusFacts facts, double seconds, const std::string& problem) {
  facts.looked_s = seconds;
  facts.problem = problem;
  if (!facts.has_run || facts.over) return facts;
  facts.elapsed_s += seconds;
  for (WorkerFacts& each : facts.workers) each.state.silent_s += seconds;
  if (facts.eta_s >= 0) facts.eta_s = std::max(0.0, facts.eta_s - seconds);
  if (seconds <= k_quiet_s) return facts;
  facts.works = false;
  facts.warns = true;
  facts.rate = 0;
  facts.eta_s = -1;
  facts.phase = "the stage could not be looked at for " + duration_text(seconds) +
                "; before that: " + facts.phase;
  return facts;
}

bool is_silent(const StageStatus& status) {
  if (!status.trace || status.trace->end) return false;
  return !status.now_unix_s || age_of(status) > k_quiet_s;
}

bool is_over(const StageStatus& status) {
  return status.trace && status.trace->end;
}

}  // namespace meshfarm
