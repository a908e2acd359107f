// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/report/status.hpp>

namespace meshfarm {
namespace {

bool status_has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Two workers, one job done, three seconds ago.
StageStatus status() {
  StageStatus status;
  status.stage = "stage";
  status.manifest.input = "mesh.ply";
  status.manifest.parts.resize(4);
  Trace trace;
  trace.head.epoch = 2;
  trace.head.host = "here";
  trace.head.unix_s = 1000;
  trace.joined = {{0.5, 1, "fast", 11, 2'000'000, 1 << 30, 1}, {0.6, 2, "slow", 12, 0, 0, 1}};
  TraceDone done;
  done.t = 8;
  done.worker = 1;
  done.triangles = 6'000'000;
  done.compute_ms = 3000;
  trace.done = {done};
  TraceState state;
  state.t = 10;
  state.jobs_known = 4;
  state.jobs_done = 1;
  state.jobs_running = 2;
  state.retries = 1;
  state.triangles_known = 24'000'000;
  state.triangles_done = 6'000'000;
  state.stages = {{"sort", 3, 3}, {"climb", 1, 0}};
  state.sink = true;
  state.workers = {{1, 2, 3, 2e6, 50 << 20, 0.5}, {2, 1, 0, 1e6, 40 << 20, 0.25}};
  trace.state = state;
  status.trace = trace;
  status.now_unix_s = 1013;
  return status;
}

TEST_CASE("the status of a run in progress") {
  const std::string text = render(status(), Format::text);
  CHECK(status_has(text, "simplifying"));
  CHECK(status_has(text, "1 of 4 done, 2 running, 0 failed, 1 retried"));
  CHECK(status_has(text, "sort 3 of 3, climb 0 of 1"));
  CHECK(status_has(text, "epoch 2 on here, for 13 s"));
  // 6 M in 5 s (from the job's start to the state), 18 M are left.
  CHECK(status_has(text, "1.2 M triangles/s, farm done in 15 s"));
  CHECK(status_has(text, "fast:11"));
  CHECK(status_has(text, "3.5 s ago"));  // the state itself is three seconds old
  CHECK(status_has(text, "50 MiB"));
  CHECK_FALSE(is_over(status()));
  const std::string json = render(status(), Format::json);
  CHECK(status_has(json, "\"eta_s\": 15.0"));
  CHECK(status_has(json, "\"heartbeat_s\": 3.25"));
  CHECK(status_has(json, "\"host\": \"slow\""));
}

TEST_CASE("a phase has a name") {
  const auto phase = [](const auto& change) {
    StageStatus changed = status();
    change(changed);
    return render(changed, Format::text);
  };
  CHECK(status_has(phase([](auto& s) { s.trace->state->sink = false; }), "waiting for the sink"));
  CHECK(status_has(phase([](auto& s) { s.trace->state->workers.clear(); }), "waiting for workers"));
  CHECK(
      status_has(phase([](auto& s) { s.trace->state->jobs_done = 4; }), "stitching and finishing"));
  CHECK(status_has(phase([](auto& s) { s.trace->state->storage_stalls = true; }), "which stalls"));
  CHECK(status_has(phase([](auto& s) { s.trace->state->no_room = true; }),
                   "no room on the stage, waiting"));
  CHECK(status_has(phase([](auto& s) {
                     s.trace->state->no_room = true;
                     s.trace->state->jobs_done = 4;
                   }),
                   "no room for the result, waiting"));
  CHECK(status_has(phase([](auto& s) { s.no_room = true; }), "no room on the stage, waiting\n"));
  CHECK(status_has(
      phase([](auto& s) {
        s.no_room = true;
        s.now_unix_s = 1100;
      }),
      "no room on the stage, waiting; the ventilator, if it lives, could write nothing"));
  CHECK(status_has(phase([](auto& s) { s.trace->state->bad_hosts = {"bad"}; }), "bad hosts"));
  CHECK(status_has(phase([](auto& s) { s.now_unix_s = 1100; }),
                   "no word from the ventilator for 1 min"));
  CHECK(status_has(phase([](auto& s) { s.now_unix_s.reset(); }),
                   "when last heard of, at an unknown time"));
  CHECK(status_has(phase([](auto& s) { s.now_unix_s = 1017; }),
                   "simplifying when last heard of, 7 s ago"));
  CHECK(status_has(phase([](auto& s) {
                     s.now_unix_s = 1017;
                     s.trace->state->jobs_done = 4;
                   }),
                   "stitching and finishing when last heard of, 7 s ago"));
  CHECK(status_has(phase([](auto& s) {
                     s.trace->end = TraceEnd{11, ""};
                   }),
                   "phase            done"));
  CHECK(status_has(phase([](auto& s) { s.trace->end = TraceEnd{11, "full"}; }), "stopped: full"));
  CHECK(status_has(phase([](auto& s) { s.trace.reset(); }), "none yet"));
}

TEST_CASE("a run whose last word is old, or may be, is silent") {
  StageStatus asked = status();
  CHECK_FALSE(is_silent(asked));  // three seconds
  asked.now_unix_s = 1020;
  CHECK(is_silent(asked));
  asked.now_unix_s.reset();
  CHECK(is_silent(asked));
  asked.trace->end = TraceEnd{11, ""};
  CHECK_FALSE(is_silent(asked));
}

}  // namespace
}  // namespace meshfarm
