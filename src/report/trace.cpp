// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A trace is a text of JSON objects, one per line, the first of kind "run":
//
//   {"kind": "run", "version": 1, ...}    TraceHead
//   {"kind": "joined" | "left" | "done" | "failed" | "state" | "end", "t": seconds, ...}
//
// with the fields of the structs in trace.hpp; keys, being 64 bits wide, are sixteen hexadecimal
// digits. Lines of other kinds are left out, fields that are missing have their defaults.
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <meshfarm/report/trace.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "report/json.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_version = 1;

// --- writing

Json to_json(const TraceHead& l) {
  return {{"kind", "run"},
          {"version", k_version},
          {"epoch", l.epoch},
          {"run", to_hex(l.run)},
          {"unix_s", l.unix_s},
          {"host", l.host},
          {"heartbeat_ms", l.heartbeat_ms},
          {"schedule", l.schedule},
          {"triangles", l.triangles},
          {"cut_s", l.cut_s}};
}

Json to_json(const TraceJoined& l) {
  return {{"kind", "joined"},   {"t", l.t},       {"worker", l.worker},
          {"host", l.host},     {"pid", l.pid},   {"speed", l.speed},
          {"memory", l.memory}, {"pool", l.pool}, {"threads", l.threads}};
}

Json to_json(const TraceLeft& l) {
  return {{"kind", "left"}, {"t", l.t}, {"worker", l.worker}, {"why", l.why}};
}

Json to_json(const TraceDone& l) {
  Json needs = Json::array();
  for (const TraceDone::Needs& n : l.needs) needs.push_back({n.stage, n.first, n.count});
  return {{"kind", "done"},
          {"t", l.t},
          {"worker", l.worker},
          {"job", to_hex(l.job)},
          {"job_kind", l.kind},
          {"stage", l.stage},
          {"index", l.index},
          {"needs", needs},
          {"triangles", l.triangles},
          {"memory", l.memory},
          {"read_bytes", l.read_bytes},
          {"extent", to_hex(l.extent)},
          {"extent_bytes", l.extent_bytes},
          {"written_bytes", l.written_bytes},
          {"read_ms", l.read_ms},
          {"wait_ms", l.wait_ms},
          {"compute_ms", l.compute_ms},
          {"write_ms", l.write_ms},
          {"cpu_us", l.cpu_us}};
}

Json to_json(const TraceFailed& l) {
  return {
      {"kind", "failed"}, {"t", l.t}, {"worker", l.worker}, {"job", to_hex(l.job)}, {"why", l.why}};
}

Json to_json(const TraceState& l) {
  Json workers = Json::array();
  for (const TraceState::Worker& w : l.workers) {
    workers.push_back({{"worker", w.worker},
                       {"held", w.held},
                       {"buffer", w.buffer},
                       {"speed", std::round(w.speed)},
                       {"rss_bytes", w.rss_bytes},
                       {"silent_s", w.silent_s}});
  }
  Json stages = Json::array();
  for (const TraceState::Stage& each : l.stages) {
    stages.push_back({{"stage", each.stage}, {"jobs", each.jobs}, {"done", each.done}});
  }
  return {{"kind", "state"},
          {"t", l.t},
          {"jobs_done", l.jobs_done},
          {"jobs_running", l.jobs_running},
          {"jobs_failed", l.jobs_failed},
          {"jobs_known", l.jobs_known},
          {"stages", stages},
          {"retries", l.retries},
          {"triangles_done", l.triangles_done},
          {"triangles_known", l.triangles_known},
          {"sink", l.sink},
          {"storage_stalls", l.storage_stalls},
          {"no_room", l.no_room},
          {"bad_hosts", l.bad_hosts},
          {"workers", workers}};
}

Json to_json(const TraceEnd& l) {
  return {{"kind", "end"}, {"t", l.t}, {"failure", l.failure}};
}

// --- reading: each field must be of its kind and in range, since other numbers would wrap around

template <class T>
void get(const Json& json, const char* name, T& value) {
  const auto found = json.find(name);
  if (found == json.end()) return;
  if constexpr (std::is_same_v<T, bool>) {
    if (found->is_boolean()) return void(value = found->get<bool>());
  } else if constexpr (std::is_same_v<T, double>) {
    if (found->is_number()) return void(value = found->get<double>());
  } else if constexpr (std::is_unsigned_v<T>) {
    const bool number = found->is_number_unsigned();
    if (number && found->get<std::uint64_t>() <= std::numeric_limits<T>::max()) {
      return void(value = found->get<T>());
    }
  } else {
    return void(value = found->get<T>());
  }
  throw DataError("\"" + std::string(name) + "\" is of the wrong kind");
}

void get_key(const Json& json, const char* name, std::uint64_t& value) {
  std::string digits;
  get(json, name, digits);
  const char* last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, value, 16);
  if (error != std::errc{} || end != last) {
    throw DataError("\"" + std::string(name) + "\" is no key");
  }
}

TraceHead read_head(const Json& json) {
  TraceHead l;
  std::uint64_t version = 0;
  get(json, "version", version);
  if (version != k_version) throw DataError("a trace of an unknown version");
  get(json, "epoch", l.epoch);
  get_key(json, "run", l.run);
  get(json, "unix_s", l.unix_s);
  get(json, "host", l.host);
  get(json, "heartbeat_ms", l.heartbeat_ms);
  get(json, "schedule", l.schedule);
  get(json, "triangles", l.triangles);
  get(json, "cut_s", l.cut_s);
  return l;
}

void read(const Json& json, TraceJoined& l) {
  get(json, "worker", l.worker);
  get(json, "host", l.host);
  get(json, "pid", l.pid);
  get(json, "speed", l.speed);
  get(json, "memory", l.memory);
  get(json, "pool", l.pool);
  get(json, "threads", l.threads);
}

void read(const Json& json, TraceLeft& l) {
  get(json, "worker", l.worker);
  get(json, "why", l.why);
}

void read_needs(const Json& json, std::vector<TraceDone::Needs>& needs) {
  const auto found = json.find("needs");
  if (found == json.end()) return;
  const auto number = [](const Json& value) {
    const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= most;
  };
  const bool fine =
      found->is_array() && std::all_of(found->begin(), found->end(), [&](const Json& each) {
        return each.is_array() && each.size() == 3 && each[0].is_string() && number(each[1]) &&
               number(each[2]);
      });
  if (!fine) throw DataError("\"needs\" is of the wrong kind");
  for (const Json& each : *found) {
    needs.push_back(
        {each[0].get<std::string>(), each[1].get<std::uint32_t>(), each[2].get<std::uint32_t>()});
  }
}

void read(const Json& json, TraceDone& l) {
  get(json, "worker", l.worker);
  get_key(json, "job", l.job);
  get(json, "job_kind", l.kind);
  get(json, "stage", l.stage);
  get(json, "index", l.index);
  read_needs(json, l.needs);
  get(json, "round", l.round);
  get(json, "triangles", l.triangles);
  get(json, "memory", l.memory);
  get(json, "read_bytes", l.read_bytes);
  if (json.contains("extent")) get_key(json, "extent", l.extent);
  get(json, "extent_bytes", l.extent_bytes);
  get(json, "written_bytes", l.written_bytes);
  get(json, "read_ms", l.read_ms);
  get(json, "wait_ms", l.wait_ms);
  get(json, "compute_ms", l.compute_ms);
  get(json, "write_ms", l.write_ms);
  get(json, "cpu_us", l.cpu_us);
}

void read(const Json& json, TraceFailed& l) {
  get(json, "worker", l.worker);
  get_key(json, "job", l.job);
  get(json, "why", l.why);
}

void read_stages(const Json& json, std::vector<TraceState::Stage>& stages) {
  const auto found = json.find("stages");
  if (found == json.end()) return;
  for (const Json& each : *found) {
    if (!each.is_object()) throw DataError("a stage is no JSON object");
    TraceState::Stage stage;
    get(each, "stage", stage.stage);
    get(each, "jobs", stage.jobs);
    get(each, "done", stage.done);
    stages.push_back(std::move(stage));
  }
}

void read(const Json& json, TraceState& l) {
  get(json, "jobs_done", l.jobs_done);
  get(json, "jobs_running", l.jobs_running);
  get(json, "jobs_failed", l.jobs_failed);
  get(json, "jobs_known", l.jobs_known);
  get(json, "retries", l.retries);
  get(json, "triangles_done", l.triangles_done);
  get(json, "triangles_known", l.triangles_known);
  get(json, "sink", l.sink);
  get(json, "storage_stalls", l.storage_stalls);
  get(json, "no_room", l.no_room);
  get(json, "bad_hosts", l.bad_hosts);
  read_stages(json, l.stages);
  const auto workers = json.find("workers");
  if (workers == json.end()) return;
  for (const Json& each : *workers) {
    if (!each.is_object()) throw DataError("a worker is no JSON object");
    TraceState::Worker worker;
    get(each, "worker", worker.worker);
    get(each, "held", worker.held);
    get(each, "buffer", worker.buffer);
    get(each, "speed", worker.speed);
    get(each, "rss_bytes", worker.rss_bytes);
    get(each, "silent_s", worker.silent_s);
    l.workers.push_back(worker);
  }
}

void read(const Json& json, TraceEnd& l) {
  get(json, "failure", l.failure);
}

template <class Line>
Line line_of(const Json& json) {
  Line line;
  get(json, "t", line.t);
  read(json, line);
  return line;
}

void add_json(const Json& json, Trace& trace) {
  std::string kind;
  get(json, "kind", kind);
  if (kind == "joined") trace.joined.push_back(line_of<TraceJoined>(json));
  if (kind == "left") trace.left.push_back(line_of<TraceLeft>(json));
  if (kind == "done") trace.done.push_back(line_of<TraceDone>(json));
  if (kind == "failed") trace.failed.push_back(line_of<TraceFailed>(json));
  if (kind == "state") trace.state = line_of<TraceState>(json);
  if (kind == "end") trace.end = line_of<TraceEnd>(json);
}

}  // namespace

std::string to_line(const TraceLine& line) {
  const Json json = std::visit([](const auto& each) { return to_json(each); }, line);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void TraceFeed::add_line(std::string_view line, Trace& trace) {
  const std::string where = what_ + ", line " + std::to_string(++lines_) + ": ";
  try {
    const Json json = Json::parse(line);
    if (!json.is_object()) throw DataError("no JSON object");
    if (lines_ == 1) trace.head = read_head(json);
    add_json(json, trace);
  } catch (const Json::exception& error) {
    throw DataError(where + error.what());
  } catch (const DataError& error) {
    throw DataError(where + error.what());
  }
}

void TraceFeed::add(std::string_view piece, Trace& trace) {
  for (std::size_t end = piece.find('\n'); end != std::string_view::npos; end = piece.find('\n')) {
    if (rest_.empty()) {
      add_line(piece.substr(0, end), trace);
    } else {
      rest_ += piece.substr(0, end);
      add_line(std::exchange(rest_, {}), trace);
    }
    piece.remove_prefix(end + 1);
  }
  rest_ += piece;
}

Trace parse_trace(std::string_view text, std::string_view what) {
  Trace trace;
  TraceFeed feed{std::string(what)};
  feed.add(text, trace);
  if (feed.lines() == 0) throw DataError(std::string(what) + ": an empty trace");
  return trace;
}

}  // namespace meshfarm
