// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>
#include <vector>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/status.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/text.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

Json as_json(const WorkerFacts& w) {
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

Json as_json(const StatusFacts& facts) {
  const TraceState& s = facts.state;
  Json json = {{"stage", facts.stage},
               {"input", facts.input},
               {"triangles", facts.triangles},
               {"parts", facts.parts},
               {"cut_s", facts.cut_s},
               {"free_bytes", facts.free_bytes ? Json(*facts.free_bytes) : Json(nullptr)},
               {"looked_s", facts.looked_s},
               {"problem", facts.problem}};
  if (!facts.has_run) {
    json["phase"] = "cut";
    json["run_phase"] = facts.phase;
    return json;
  }
  Json workers = Json::array();
  for (const WorkerFacts& each : facts.workers) workers.push_back(as_json(each));
  json["run"] = to_hex(facts.head.run);
  json["epoch"] = facts.head.epoch;
  json["host"] = facts.head.host;
  json["phase"] = facts.phase;
  json["over"] = facts.over;
  json["works"] = facts.works;
  json["warns"] = facts.warns;
  json["elapsed_s"] = facts.elapsed_s;
  json["heard_s"] = facts.age_s;
  json["eta_s"] = facts.eta_s < 0 ? Json(nullptr) : Json(facts.eta_s);
  json["triangles_per_s"] = facts.rate;
  json["work"] = {{"known", s.triangles_known}, {"done", s.triangles_done}};
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
  json["no_room"] = s.no_room;
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

std::string table_of(const std::vector<WorkerFacts>& workers) {
  std::string text = padded("worker", 6) + padded("host", -20) + padded("speed", 12) +
                     padded("held", 5) + padded("buffer", 6) + padded("done", 7) +
                     padded("memory", 11) + "heartbeat\n";
  for (const WorkerFacts& w : workers) {
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

std::string render(const StatusFacts& facts, Format format) {
  if (format == Format::json) {
    return as_json(facts).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  std::string text =
      line("stage", facts.stage + ", " + facts.input + ", " + grouped(facts.triangles) +
                        " triangles in " + grouped(facts.parts) + " parts");
  if (!facts.has_run) return text + line("run", facts.phase);
  const TraceState& s = facts.state;
  text += line("run", "epoch " + std::to_string(facts.head.epoch) + " on " + facts.head.host +
                          ", for " + duration_text(facts.elapsed_s));
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
  if (facts.free_bytes && !facts.over) {
    text += line("room", gib(*facts.free_bytes) + " on the stage");
  }
  if (!s.bad_hosts.empty()) {
    text += line("bad hosts", joined(s.bad_hosts) + ": get no more jobs, too many failed there");
  }
  if (facts.times) {
    text += line("last summary", "farm " + number(facts.times->farm, "%.2f s") + ", stitch " +
                                     number(facts.times->stitch, "%.2f s") + ", finish " +
                                     number(facts.times->finish, "%.2f s"));
  }
  text += line("workers", grouped(facts.workers.size()) + ", " + grouped(facts.workers_left) +
                              " left or were lost");
  if (!facts.workers.empty()) text += "\n" + table_of(facts.workers);
  return text;
}

}  // namespace meshfarm
