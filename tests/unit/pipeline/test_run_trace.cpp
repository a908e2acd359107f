// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <thread>

#include <doctest/doctest.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

TEST_CASE("what a ventilator tells is in the stage's trace") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  CHECK_THROWS_AS(read_newest_trace(stage), DataError);
  TraceHead head;
  head.run = 77;
  RunTrace trace(stage, head);
  VentilatorOptions options;
  trace.follow(options);
  options.event(RunBegan{3, "here"}, FarmTime(0));
  options.event(WorkerJoined{{1}, "host", 5, {1000, 2000, 4}}, FarmTime(500));
  Job job{"simplify", {{"parts/000001.part", 100, 0}, {"parts/000002.part", 11, 0}}, "", 7};
  job.memory = 9;
  job.extent = {0xfedcba9876543210, 100};
  const JobPlace place{"climb", 6, {{"sort", 0, 12}}};
  options.event(JobAccepted{{1}, {42}, job, place, 33, {1, 2, 3, 4, 5}}, FarmTime(1500));
  options.event(AttemptFailed{{1}, {43}, "no luck"}, FarmTime(1600));
  FarmProgress progress;
  progress.jobs_done = 1;
  progress.jobs_known = 2;
  progress.bad_hosts = {"bad"};
  WorkerStatus worker;
  worker.id = {1};
  worker.silent = FarmTime(250);
  options.state(progress, {worker}, FarmTime(2000));
  options.event(WorkerLeft{{1}, "left"}, FarmTime(2500));
  trace.end("why");

  const Trace read = read_newest_trace(stage);
  CHECK(read.head.epoch == 3);
  CHECK(read.head.run == 77);
  CHECK(read.head.host == "here");
  CHECK(read.joined.at(0).threads == 4);
  const TraceDone& done = read.done.at(0);
  CHECK(done.t == 1.5);
  CHECK(done.job == 42);
  CHECK(done.stage == "climb");
  CHECK(done.index == 6);
  CHECK(done.needs.at(0).stage == "sort");
  CHECK(done.needs.at(0).count == 12);
  CHECK(done.read_bytes == 111);
  CHECK(done.extent == 0xfedcba9876543210);
  CHECK(done.extent_bytes == 100);
  CHECK(done.written_bytes == 33);
  CHECK(done.memory == 9);
  CHECK(done.cpu_us == 5);
  CHECK(read.failed.at(0).why == "no luck");
  CHECK(read.state->workers.at(0).silent_s == 0.25);
  CHECK(read.state->bad_hosts.at(0) == "bad");
  CHECK(read.left.at(0).why == "left");
  CHECK(read.end->failure == "why");
  CHECK(read.end->t == 2.5);
}

TEST_CASE("a trace ends when its run did, not at the last that was told before") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  RunTrace trace(stage, {});
  VentilatorOptions options;
  trace.follow(options);
  options.event(RunBegan{1, "here"}, FarmTime(0));
  options.event(WorkerLeft{{1}, "left"}, FarmTime(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  trace.end("stopped");
  CHECK(read_newest_trace(stage).end->t >= 0.06);
}

TEST_CASE("jobs that were done before a ventilator was killed belong to its run") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  const auto epoch = [&](std::uint32_t number, std::uint64_t run, std::uint64_t job) {
    TraceHead head;
    head.run = run;
    RunTrace trace(stage, head);
    VentilatorOptions options;
    trace.follow(options);
    options.event(RunBegan{number, "here"}, FarmTime(0));
    options.event(WorkerJoined{{1}, "host", 5, {}}, FarmTime(500));
    options.event(JobAccepted{{1}, {job}, {}, {}, 33, {}}, FarmTime(1500));
  };
  epoch(1, 7, 41);
  epoch(3, 8, 42);  // another run
  epoch(5, 7, 43);
  const Trace run = read_traced_run(stage);
  CHECK(run.head.epoch == 5);
  REQUIRE(run.done.size() == 2);
  CHECK(run.done[0].job == 41);
  CHECK(run.done[1].job == 43);
  CHECK(run.done[0].worker != run.done[1].worker);
}

TEST_CASE("an output was made if its run's ventilator was killed before it heard so") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  CHECK_FALSE(output_was_made(stage, 5));
  const auto announce = [&](std::uint64_t run, const std::string& address) {
    return publish_endpoint(stage, {0, run, address, "host", 1, {}}, "u").epoch;
  };
  RunSummary summary;
  summary.manifest.box.add({0, 0, 0});
  summary.manifest.box.add({1, 1, 1});
  summary.run = 5;
  publish_summary(stage, summary);
  announce(5, "tcp://a");
  CHECK_FALSE(output_was_made(stage, 5));  // an older version does not tell its epoch
  summary.epoch = announce(5, "tcp://b");
  publish_summary(stage, summary);
  announce(6, "");
  announce(5, "tcp://c");  // started again
  CHECK(output_was_made(stage, 5));
  CHECK_FALSE(output_was_made(stage, 6));
  announce(5, "");
  CHECK_FALSE(output_was_made(stage, 5));  // that run is over
  announce(5, "tcp://d");
  CHECK_FALSE(output_was_made(stage, 5));
}

TEST_CASE("the newest summary of a run is found again") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  CHECK_FALSE(read_run_times(stage, 5));
  RunSummary summary;
  summary.manifest.box.add({0, 0, 0});
  summary.manifest.box.add({1, 1, 1});
  for (const std::uint64_t run : {5, 6, 5}) {
    summary.run = run;
    summary.finish_seconds += 1.5;
    summary.triangles = 10 * run;
    publish_summary(stage, summary);
  }
  REQUIRE(read_run_times(stage, 5));
  CHECK(read_run_times(stage, 5)->finish == 4.5);
  CHECK(read_run_times(stage, 5)->triangles_out == 50);
  CHECK(read_run_times(stage, 6)->finish == 3.0);
  CHECK_FALSE(read_run_times(stage, 7));
  CHECK_THROWS_AS(parse_run_times("{}", "it"), DataError);
  const std::string seconds =
      "\"cut\":1,\"farm\":1,\"stitch\":1,\"finish\":1,\"measure\":1,\"write\":1";
  const auto with = [&](const char* triangles) {
    return "{\"run\":\"5\",\"seconds\":{" + seconds + "},\"output\":{\"triangles\":" + triangles +
           "}}";
  };
  CHECK(parse_run_times(with("7"), "it").triangles_out == 7);
  CHECK_THROWS_AS(parse_run_times(with("1e30"), "it"), DataError);
  CHECK_THROWS_AS(parse_run_times(with("-1"), "it"), DataError);
}

}  // namespace
}  // namespace meshfarm
