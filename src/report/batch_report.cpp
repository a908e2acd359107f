// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/report/batch_report.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

using State = BatchReport::State;

const char* name_of(State state) {
  switch (state) {
    case State::done:
      return "done";
    case State::done_before:
      return "done before";
    case State::failed:
      return "failed";
    case State::stopped:
      return "not done";
  }
  return "";
}

Json summary_of(const BatchReport::File& file) {
  return file.summary.empty() ? Json(nullptr) : Json::parse(file.summary, nullptr, false);
}

/// "871,414 to 8,712 triangles, rms 0.000311"
std::string result_of(const BatchReport::File& file) {
  try {
    const Json json = summary_of(file);
    std::string text = grouped(json.at("input").at("triangles").get<std::uint64_t>()) + " to " +
                       grouped(json.at("output").at("triangles").get<std::uint64_t>()) +
                       " triangles";
    const Json& error = json.at("error");
    if (error.is_object()) text += ", rms " + number(error.at("rms").get<double>(), "%.3g");
    return text;
  } catch (const Json::exception&) {
    return {};
  }
}

std::size_t jobs_in(const BatchReport& report, State state) {
  return static_cast<std::size_t>(
      std::count_if(report.files.begin(), report.files.end(),
                    [&](const BatchReport::File& each) { return each.state == state; }));
}

std::string as_json(const BatchReport& report) {
  Json files = Json::array();
  for (const BatchReport::File& each : report.files) {
    files.push_back({{"input", each.input},
                     {"output", each.output},
                     {"state", name_of(each.state)},
                     {"reason", each.reason},
                     {"seconds", each.seconds},
                     {"summary", summary_of(each)}});
  }
  const Json json = {{"files", files},
                     {"done", jobs_in(report, State::done)},
                     {"done_before", jobs_in(report, State::done_before)},
                     {"failed", jobs_in(report, State::failed)},
                     {"not_done", jobs_in(report, State::stopped)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string render(const BatchReport& report, Format format) {
  if (format == Format::json) return as_json(report);
  std::string text;
  for (const BatchReport::File& each : report.files) {
    std::string state = name_of(each.state);
    state.resize(13, ' ');
    text += state + each.input;
    if (each.state == State::done) {
      text += " -> " + each.output;
      const std::string result = result_of(each);
      if (!result.empty()) text += ": " + result;
      text += ", " + number(each.seconds, "%.1f s");
    }
    if (each.state == State::done_before) text += " -> " + each.output;
    if (!each.reason.empty()) text += ": " + each.reason;
    text += "\n";
  }
  text += grouped(report.files.size()) + (report.files.size() == 1 ? " file: " : " files: ") +
          grouped(jobs_in(report, State::done)) + " done";
  for (const State state : {State::done_before, State::failed, State::stopped}) {
    const std::size_t count = jobs_in(report, state);
    if (count > 0) text += ", " + grouped(count) + " " + name_of(state);
  }
  return text + "\n";
}

}  // namespace meshfarm
