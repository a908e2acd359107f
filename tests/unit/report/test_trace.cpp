// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/report/trace.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

std::string text_of(const std::vector<TraceLine>& lines) {
  std::string text;
  for (const TraceLine& line : lines) text += to_line(line) + "\n";
  return text;
}

TraceHead head() {
  return {3, 0xfedcba9876543210, 1.5e9, "here", 1000, "dynamic", 28'000'000, 1.25};
}

TEST_CASE("a trace comes back as it was written") {
  TraceState state{.t = 4, .jobs_done = 1, .jobs_running = 2, .jobs_failed = 3, .jobs_known = 4};
  state.retries = 5;
  state.triangles_done = 6;
  state.triangles_known = 7;
  state.stages = {{"sort", 8, 7}, {"climb", 9, 0}};
  state.sink = true;
  state.storage_stalls = true;
  state.bad_hosts = {"bad"};
  state.workers = {{1, 2, 3, 4, 5, 6.5}};
  const TraceDone done{.t = 1,
                       .worker = 1,
                       .job = 0x0123456789abcdef,
                       .kind = "simplify",
                       .stage = "climb",
                       .index = 7,
                       .needs = {{"sort", 0, 12}, {"sample", 7, 1}},
                       .triangles = 2,
                       .write_ms = 9,
                       .cpu_us = 10};
  const std::string text = text_of(
      {head(), TraceJoined{0.5, 1, "host \"1\"\n", 77, 2'000'000, 1ULL << 40, 2}, done,
       TraceFailed{2, 1, 5, "no luck"}, TraceLeft{3, 1, "was silent"}, state, TraceEnd{5, "why"}});
  const Trace trace = parse_trace(text, "trace");
  CHECK(trace.head.run == 0xfedcba9876543210);
  CHECK(trace.head.schedule == "dynamic");
  REQUIRE(trace.joined.size() == 1);
  CHECK(trace.joined[0].host == "host \"1\"\n");
  CHECK(trace.joined[0].memory == 1ULL << 40);
  REQUIRE(trace.done.size() == 1);
  CHECK(trace.done[0].job == 0x0123456789abcdef);
  CHECK(trace.done[0].write_ms == 9);
  CHECK(trace.done[0].stage == "climb");
  CHECK(trace.done[0].index == 7);
  REQUIRE(trace.done[0].needs.size() == 2);
  CHECK(trace.done[0].needs[0].stage == "sort");
  CHECK(trace.done[0].needs[0].count == 12);
  CHECK(trace.done[0].needs[1].first == 7);
  CHECK(trace.done[0].cpu_us == 10);
  REQUIRE(trace.state->stages.size() == 2);
  CHECK(trace.state->stages[0].stage == "sort");
  CHECK(trace.state->stages[0].done == 7);
  CHECK(trace.state->stages[1].jobs == 9);
  CHECK(trace.failed.at(0).why == "no luck");
  CHECK(trace.left.at(0).why == "was silent");
  REQUIRE(trace.state);
  CHECK(trace.state->workers.at(0).silent_s == 6.5);
  CHECK(trace.state->bad_hosts.at(0) == "bad");
  CHECK(trace.end->failure == "why");
  CHECK(text_of({head(), trace.joined[0], trace.done[0], trace.failed[0], trace.left[0],
                 *trace.state, *trace.end}) == text);
}

TEST_CASE("a trace of a version that had rounds is read") {
  const std::string line = R"({"kind": "done", "t": 1, "worker": 1, "job": "1", "round": 2})";
  const Trace trace = parse_trace(to_line(head()) + "\n" + line + "\n", "trace");
  REQUIRE(trace.done.size() == 1);
  CHECK(trace.done[0].stage.empty());
  CHECK(trace.done[0].round == 2);
}

TEST_CASE("a trace that still grows may end in the midst of a line") {
  const std::string text = text_of({head(), TraceEnd{5, ""}});
  for (std::size_t size = text.find('\n') + 1; size < text.size(); ++size) {
    CHECK_FALSE(parse_trace(text.substr(0, size), "trace").end);
  }
  CHECK(parse_trace(text, "trace").end);
}

TEST_CASE("what is no trace is refused with the line") {
  const std::string good = to_line(head()) + "\n";
  const std::pair<std::string, const char*> bad[] = {
      {"", "trace: an empty trace"},
      {"{\"version\": 2.7e9}\n", "line 1: \"version\" is of the wrong kind"},
      {"{\"version\": 4294967297}\n", "a trace of an unknown version"},
      {good + "{\"kind\": \"left\", \"worker\": 4294967296}\n",
       "line 2: \"worker\" is of the wrong"},
      {"hello\n", "trace, line 1: "},
      {"[1]\n", "trace, line 1: no JSON object"},
      {"{}\n", "line 1: a trace of an unknown version"},
      {"{\"version\": 2}\n", "line 1: a trace of an unknown version"},
      {good + "{\"kind\": \"end\", \"t\": \"x\"}\n", "line 2: \"t\" is of the wrong kind"},
      {good + "{\"kind\": \"done\", \"worker\": -1}\n", "line 2: \"worker\" is of the wrong kind"},
      {good + "{\"kind\": \"done\", \"job\": \"xyz\"}\n", "line 2: \"job\" is no key"},
      {good + "{\"kind\": \"done\", \"job\": \"1\", \"needs\": [[\"sort\", 0]]}\n",
       "line 2: \"needs\" is of the wrong kind"},
      {good + "{\"kind\": \"done\", \"job\": \"1\", \"needs\": [[\"sort\", 0, 4294967296]]}\n",
       "line 2: \"needs\" is of the wrong kind"},
      {good + "{\"kind\": \"state\", \"workers\": [3]}\n", "line 2: "}};
  for (const auto& each : bad) {
    const auto& text = each.first;
    const auto& message = each.second;
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(parse_trace(text, "trace"), doctest::Contains(message), DataError);
  }
  CHECK(parse_trace(good + "{\"kind\": \"news\"}\n", "trace").done.empty());
}

}  // namespace
}  // namespace meshfarm
