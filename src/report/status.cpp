// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <vector>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/status.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/text.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

/// A ventilator writes at least every second, and no later than its disk: one that wrote nothing
/// for so long is gone or cut off.
constexpr double k_silent_s = 15;
/// Then it may be worth finding out why.
constexpr double k_quiet_s = 3;
/// The rate is that of the last jobs: as many seconds, if there are jobs in them.
constexpr double k_rate_window_s = 60;

/// A worker of the newest state, with what else the trace has of it.
struct WorkerLine {
  TraceJoined joined;
  TraceState::Worker state;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
};

/// What the status says, derived from the trace.
struct Facts {
  std::string phase;
  TraceState state;
  double age_s = 0;   // since the last word of the trace; 0: it cannot be told, or that was the end
  double rate = 0;    // triangles a second
  double eta_s = -1;  // below 0: not known
  double elapsed_s = 0;
  std::vector<WorkerLine> workers;
  std::uint64_t workers_left = 0;
};

double last_time(const Trace& trace) {
  double t = trace.state ? trace.state->t : 0;
  if (!trace.done.empty()) t = std::max(t, trace.done.back().t);
  if (trace.end) t = std::max(t, trace.end->t);
  return t;
}

std::string phase_of(const StageStatus& status, const Facts& facts) {
  const Trace& trace = *status.trace;
  if (trace.end && !trace.end->failure.empty()) return "stopped: " + trace.end->failure;
  if (trace.end) return "done";
  if (status.no_room) {
    std::string phase = "no room on the stage, waiting";
    if (facts.age_s > k_silent_s) {
      phase +=
          "; the ventilator, if it lives, could write nothing for " + duration_text(facts.age_s);
    }
    return phase;
  }
  if (facts.age_s > k_silent_s) {
    return "no word from the ventilator for " + duration_text(facts.age_s) +
           " (killed, cut off, or its storage stalls)";
  }
  const TraceState& state = facts.state;
  if (!state.sink) return "waiting for the sink";
  const bool farmed = state.jobs_known > 0 && state.jobs_done == state.jobs_known;
  if (state.no_room)
    return farmed ? "no room for the result, waiting" : "no room on the stage, waiting";
  if (farmed) return "stitching and finishing";
  if (state.storage_stalls) return "waiting for the storage, which stalls";
  if (state.workers.empty()) return "waiting for workers ('meshfarm worker STAGE' on any host)";
  return status.now_unix_s ? "simplifying" : "simplifying when last heard of; when, cannot be told";
}

/// Triangles a second, by the jobs that ended lately.
double rate_of(const Trace& trace, double now) {
  double triangles = 0;
  double since = now;
  for (auto job = trace.done.rbegin(); job != trace.done.rend(); ++job) {
    if (job->t < now - k_rate_window_s) break;
    triangles += static_cast<double>(job->triangles);
    since = job->t - job->compute_ms / 1000.0;
  }
  return now > since ? triangles / (now - since) : 0;
}

Facts facts_of(const StageStatus& status) {
  const Trace& trace = *status.trace;
  Facts facts;
  facts.state = trace.state.value_or(TraceState{});
  const double now = status.now_unix_s.value_or(0) - trace.head.unix_s;
  facts.age_s = trace.end ? 0 : std::max(0.0, now - last_time(trace));
  facts.elapsed_s = last_time(trace) + facts.age_s;
  facts.phase = phase_of(status, facts);
  facts.rate = rate_of(trace, last_time(trace));
  const auto left = static_cast<double>(facts.state.triangles_known - facts.state.triangles_done);
  if (!trace.end && facts.rate > 0) facts.eta_s = left / facts.rate;
  std::map<std::uint32_t, WorkerLine> known;
  for (const TraceJoined& each : trace.joined) known[each.worker].joined = each;
  for (const TraceDone& each : trace.done) ++known[each.worker].done;
  for (const TraceFailed& each : trace.failed) ++known[each.worker].failed;
  for (const TraceState::Worker& each : facts.state.workers) {
    WorkerLine line = known[each.worker];
    line.state = each;
    line.state.silent_s += facts.age_s;
    facts.workers.push_back(line);
  }
  facts.workers_left = trace.left.size();
  return facts;
}

Json as_json(const WorkerLine& w) {
  return {{"worker", w.state.worker},
          {"host", w.joined.host},
          {"pid", w.joined.pid},
          {"threads", w.joined.threads},
          {"speed", w.state.speed},
          {"benchmark", w.joined.speed},
          {"held", w.state.held},
          {"buffer", w.state.buffer},
          {"done", w.done},
          {"failed", w.failed},
          {"rss_bytes", w.state.rss_bytes},
          {"memory_bytes", w.joined.memory},
          {"heartbeat_s", w.state.silent_s}};
}

Json as_json(const StageStatus& status) {
  Json json = {{"stage", status.stage},
               {"input", status.manifest.input},
               {"triangles", status.manifest.triangles()},
               {"parts", status.manifest.part_count()},
               {"cut_s", status.manifest.cut_seconds}};
  if (!status.trace) {
    json["phase"] = "cut";
    return json;
  }
  const Facts facts = facts_of(status);
  const TraceState& s = facts.state;
  Json workers = Json::array();
  for (const WorkerLine& each : facts.workers) workers.push_back(as_json(each));
  json["run"] = to_hex(status.trace->head.run);
  json["epoch"] = status.trace->head.epoch;
  json["phase"] = facts.phase;
  json["over"] = is_over(status);
  json["elapsed_s"] = facts.elapsed_s;
  json["eta_s"] = facts.eta_s < 0 ? Json(nullptr) : Json(facts.eta_s);
  json["triangles_per_s"] = facts.rate;
  json["jobs"] = {{"known", s.jobs_known},
                  {"done", s.jobs_done},
                  {"running", s.jobs_running},
                  {"failed", s.jobs_failed},
                  {"retried", s.retries}};
  json["stages"] = Json::array();
  for (const TraceState::Stage& each : s.stages) {
    json["stages"].push_back({{"stage", each.stage}, {"known", each.jobs}, {"done", each.done}});
  }
  json["sink"] = s.sink;
  json["no_room"] = s.no_room || status.no_room;
  json["bad_hosts"] = s.bad_hosts;
  json["workers_left"] = facts.workers_left;
  json["workers"] = workers;
  return json;
}

std::string padded(std::string text, int width) {
  const auto size = static_cast<std::size_t>(std::abs(width));
  if (text.size() < size) text.insert(width < 0 ? text.size() : 0, size - text.size(), ' ');
  return text + "  ";
}

std::string mib(std::uint64_t bytes) {
  return grouped(bytes >> 20) + " MiB";
}

std::string table_of(const std::vector<WorkerLine>& workers) {
  std::string text = padded("worker", 6) + padded("host", -20) + padded("speed", 12) +
                     padded("held", 5) + padded("buffer", 6) + padded("done", 7) +
                     padded("memory", 11) + "heartbeat\n";
  for (const WorkerLine& w : workers) {
    text += padded(std::to_string(w.state.worker), 6) +
            padded(w.joined.host + ":" + std::to_string(w.joined.pid), -20) +
            padded(with_unit(w.state.speed) + " tri/s", 12) +
            padded(std::to_string(w.state.held), 5) + padded(std::to_string(w.state.buffer), 6) +
            padded(std::to_string(w.done), 7) + padded(mib(w.state.rss_bytes), 11) +
            number(w.state.silent_s, "%.1f s ago") + "\n";
  }
  return text;
}

std::string line(const std::string& label, const std::string& value) {
  return padded(label, -15) + value + "\n";
}

/// "climb 16 of 16, compose 1 of 4"
std::string words_of(const std::vector<TraceState::Stage>& stages) {
  std::vector<std::string> words;
  words.reserve(stages.size());
  for (const TraceState::Stage& each : stages) {
    words.push_back(each.stage + " " + grouped(each.done) + " of " + grouped(each.jobs));
  }
  return joined(words);
}

}  // namespace

bool is_silent(const StageStatus& status) {
  if (!status.trace || status.trace->end) return false;
  return !status.now_unix_s || facts_of(status).age_s > k_quiet_s;
}

bool is_over(const StageStatus& status) {
  return status.trace && status.trace->end;
}

std::string render(const StageStatus& status, Format format) {
  if (format == Format::json) {
    return as_json(status).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  std::string text = line("stage", status.stage + ", " + status.manifest.input + ", " +
                                       grouped(status.manifest.triangles()) + " triangles in " +
                                       grouped(status.manifest.part_count()) + " parts");
  if (!status.trace) {
    return text + line("run", status.manifest.cutting ? "none yet; the first is to cut"
                                                      : "none yet; the cut is whole");
  }
  const Facts facts = facts_of(status);
  const TraceState& s = facts.state;
  text += line("run", "epoch " + std::to_string(status.trace->head.epoch) + " on " +
                          status.trace->head.host + ", for " + duration_text(facts.elapsed_s));
  text += line("phase", facts.phase);
  text += line("jobs", grouped(s.jobs_done) + " of " + grouped(s.jobs_known) + " done, " +
                           grouped(s.jobs_running) + " running, " + grouped(s.jobs_failed) +
                           " failed, " + grouped(s.retries) + " retried");
  if (!s.stages.empty()) text += line("stages", words_of(s.stages));
  if (facts.rate > 0) {
    text +=
        line("rate", with_unit(facts.rate) + " triangles/s" +
                         (facts.eta_s < 0 ? "" : ", farm done in " + duration_text(facts.eta_s)));
  }
  if (!s.bad_hosts.empty()) {
    text += line("bad hosts", joined(s.bad_hosts) + ": get no more jobs, too many failed there");
  }
  if (status.times) {
    text += line("last summary", "farm " + number(status.times->farm, "%.2f s") + ", stitch " +
                                     number(status.times->stitch, "%.2f s") + ", finish " +
                                     number(status.times->finish, "%.2f s"));
  }
  text += line("workers", grouped(facts.workers.size()) + ", " + grouped(facts.workers_left) +
                              " left or were lost");
  if (!facts.workers.empty()) text += "\n" + table_of(facts.workers);
  return text;
}

}  // namespace meshfarm
