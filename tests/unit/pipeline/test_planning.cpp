// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/planning.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Jobs of about 0.36 s that differ by a tenth, as on a quiet machine.
std::vector<PlannedJob> jobs_of(std::uint64_t count) {
  std::vector<PlannedJob> jobs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t triangles = 1'000'000 + i * 79'190 % 50'000;
    const double seconds = static_cast<double>(triangles) * 360e-9 *
                           (0.95 + 0.1 * static_cast<double>(i * 104'729 % 1000) / 1000);
    jobs.push_back({0, triangles, 2'000'000, 800'000, seconds});
  }
  return jobs;
}

PlannedFarm farm_of(std::vector<WorkerGroup> groups, Schedule schedule = Schedule::dynamic) {
  PlannedFarm farm;
  farm.groups = std::move(groups);
  farm.schedule = schedule;
  farm.server_bytes_per_s = 12.5e9;
  return farm;
}

TEST_CASE("24 equal workers are 23 times as fast as one") {
  const auto jobs = jobs_of(1024);
  const double one = simulate_run(jobs, farm_of({{1, 1}})).farm_s;
  const PlannedRun run = simulate_run(jobs, farm_of({{24, 1}}));
  CHECK(one / run.farm_s >= 23.0);
  CHECK(one / run.farm_s <= 24.0);
}

TEST_CASE("16 fast and 8 slow workers share the work within three per cent of the ideal") {
  for (const std::uint64_t count : {512, 1024, 2048}) {
    CAPTURE(count);
    const auto jobs = jobs_of(count);
    const PlannedRun run = simulate_run(jobs, farm_of({{16, 1}, {8, 1.0 / 3}}));
    CHECK(run.farm_s / run.ideal_s <= 1.03);
    CHECK(run.farm_s >= run.ideal_s);
  }
}

TEST_CASE("where speeds are not as told, a static schedule is late and a dynamic one is not") {
  const auto jobs = jobs_of(2048);
  PlannedFarm farm = farm_of({{16, 1}, {8, 1.0 / 3}});
  farm.off = 0.2;
  const PlannedRun dynamic = simulate_run(jobs, farm);
  farm.schedule = Schedule::fixed;
  const PlannedRun fixed = simulate_run(jobs, farm);
  CHECK(dynamic.farm_s / dynamic.ideal_s <= 1.05);
  CHECK(fixed.farm_s / fixed.ideal_s >= 1.1);
}

TEST_CASE("a slow server of the shared folder is the limit of a large farm") {
  const auto jobs = jobs_of(1024);
  PlannedFarm farm = farm_of({{240, 1}});
  farm.server_bytes_per_s = 125e6;  // 1 Gbit/s, for 2 GB read and 0.8 GB written and read again
  const PlannedRun run = simulate_run(jobs, farm);
  CHECK(run.farm_s > 20);
  CHECK(run.storage_busy > 0.95);
}

TEST_CASE("jobs wait for all of less depth, or for those that they need") {
  auto jobs = jobs_of(48);
  jobs[0].compute_s = 10;
  jobs[0].triangles *= 30;
  const PlannedRun one = simulate_run(jobs, farm_of({{24, 1}}));
  for (std::size_t i = 24; i < 48; ++i) jobs[i].depth = 1;
  const PlannedRun two = simulate_run(jobs, farm_of({{24, 1}}));
  CHECK(one.farm_s == doctest::Approx(10).epsilon(0.02));
  CHECK(two.farm_s > 10.3);
  for (std::size_t i = 24; i < 48; ++i) {
    const std::size_t other = 1 + (i - 24) % 23;  // none waits for the long one
    jobs[i].needs = {{other, other + 1}};
  }
  CHECK(simulate_run(jobs, farm_of({{24, 1}})).farm_s == doctest::Approx(10).epsilon(0.02));
}

/// Jobs that read something, and others that read the same again, in the other order.
std::vector<PlannedJob> read_twice(std::uint64_t count, double seconds, std::uint64_t bytes) {
  std::vector<PlannedJob> jobs;
  for (const std::uint32_t depth : {0U, 1U}) {
    for (std::uint64_t i = 0; i < count; ++i) {
      PlannedJob job{depth, 100'000, bytes, 0, seconds};
      job.extent = {1000 + (depth == 0 ? i : count - 1 - i), bytes};
      jobs.push_back(job);
    }
  }
  return jobs;
}

TEST_CASE("a host does not read again what it has read, if it can keep that") {
  constexpr std::uint64_t k_bytes = 25'000'000;
  const std::vector<PlannedJob> jobs = read_twice(24, 0.01, k_bytes);
  PlannedFarm farm = farm_of({{8, 1}});
  const double once = 24.0 * k_bytes / 12.5e9;
  const PlannedRun kept = simulate_run(jobs, farm);
  CHECK(kept.storage_s == doctest::Approx(once).epsilon(0.1));
  farm.cache_bytes = 0;
  const PlannedRun read = simulate_run(jobs, farm);
  CHECK(read.storage_s == doctest::Approx(2 * once));
  CHECK(read.farm_s > kept.farm_s + 0.3 * once);
  farm.cache_bytes = 2 * k_bytes;  // of the three that each host has read
  CHECK(simulate_run(jobs, farm).storage_s > 1.2 * kept.storage_s);
}

TEST_CASE("where the storage costs little, nobody waits for what a host has read") {
  std::vector<PlannedJob> jobs = read_twice(96, 0.05, 1000);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    jobs[i].compute_s *= 1 + 0.5 * static_cast<double>(i * 104'729 % 1000) / 1000;
    jobs[i].triangles = static_cast<std::uint64_t>(jobs[i].compute_s * 2e6);
  }
  std::vector<PlannedJob> without = jobs;
  for (PlannedJob& job : without) job.extent = {};
  for (const PlannedFarm& farm : {farm_of({{24, 1}}), farm_of({{16, 1}, {8, 1.0 / 3}})}) {
    CHECK(simulate_run(jobs, farm).farm_s <= 1.02 * simulate_run(without, farm).farm_s);
  }
}

TEST_CASE("the same work in more parts, and a draw from it") {
  const auto jobs = jobs_of(100);
  const auto work = [](const std::vector<PlannedJob>& of) {
    return std::accumulate(of.begin(), of.end(), 0.0,
                           [](double sum, const PlannedJob& job) { return sum + job.compute_s; });
  };
  const auto parts = as_parts(jobs, 400);
  CHECK(parts.size() == 400);
  CHECK(work(parts) == doctest::Approx(work(jobs)));
  CHECK(parts[0].triangles == jobs[0].triangles / 4);

  // In a whole run only the parts change: what comes before and after stays.
  std::vector<PlannedJob> run = jobs_of(103);
  for (std::size_t i = 0; i < run.size(); ++i) {
    run[i].depth = i < 2 ? 0 : i < 102 ? 1 : 2;
    if (i < 2) run[i].compute_s /= 1000;
  }
  run[2].needs = {{0, 2}};
  run[102].needs = {{0, 1}, {3, 102}};
  const auto more = as_parts(run, 200);
  REQUIRE(more.size() == 203);
  CHECK(work(more) == doctest::Approx(work(run)));
  CHECK(more[1].compute_s == run[1].compute_s);
  CHECK(more[2].needs == run[2].needs);
  CHECK(more[202].compute_s == run[102].compute_s);
  CHECK(more[202].needs == std::vector<PlannedJob::Range>{{0, 1}, {4, 202}});

  const auto sample = drawn(jobs, 1000, 1);
  CHECK(sample.size() == 1000);
  CHECK(work(sample) == doctest::Approx(10 * work(jobs)).epsilon(0.02));

  // Jobs for samples, which are tried before the sweeps, are not drawn.
  std::vector<PlannedJob> jobs_by_depth = jobs_of(3);
  for (PlannedJob& job : jobs_by_depth) job.compute_s /= 1000;
  for (PlannedJob job : jobs) {
    job.depth = 1;
    jobs_by_depth.push_back(job);
  }
  for (const PlannedJob& job : drawn(jobs_by_depth, 50, 1)) CHECK(job.depth == 1);
}

TEST_CASE("jobs are taken from a trace: once each, by processor time, as the fastest worker's") {
  Trace trace;
  TraceDone done;
  done.triangles = 1000;
  done.job = 1;
  done.worker = 1;
  done.compute_ms = 50;  // on a busy host
  done.cpu_us = 10'000;
  trace.done.push_back(done);
  trace.done.push_back(done);  // an epoch before did it, too
  done.extent = 1;
  done.extent_bytes = 5;
  done.job = 2;
  done.kind = "climb";
  done.worker = 2;  // twice as slow
  done.cpu_us = 20'000;
  done.round = 1;
  trace.done.push_back(done);
  const auto jobs = planned_jobs(trace);
  REQUIRE(jobs.size() == 2);
  CHECK(jobs[0].compute_s == doctest::Approx(0.01));
  CHECK(jobs[1].compute_s == doctest::Approx(0.01));
  CHECK(jobs[1].depth == 1);
  CHECK(jobs[1].kind == "climb");
  CHECK(jobs[1].extent.name == 1);
  CHECK(jobs[1].extent.bytes == 5);
  CHECK_THROWS_AS(planned_jobs(Trace{}), DataError);
}

TEST_CASE("the sink's own jobs are planned as it took them, whatever their cost was held to be") {
  Trace trace;
  TraceDone done;
  done.triangles = 1000;
  done.job = 1;
  done.stage = "climb";
  done.worker = 1;
  done.cpu_us = 10'000;
  trace.done.push_back(done);
  done.job = 2;
  done.stage = "join";
  done.needs = {{"climb", 0, 1}};
  done.worker = k_sink_of_trace;
  done.triangles = 1;
  done.cpu_us = 30'000;
  trace.done.push_back(done);
  const auto jobs = planned_jobs(trace);
  REQUIRE(jobs.size() == 2);
  CHECK(jobs[0].compute_s == doctest::Approx(0.01));
  CHECK(jobs[1].compute_s == doctest::Approx(0.03));
  CHECK(jobs[1].stage == "join");
}

TEST_CASE("of each stage it is told what it takes and what it waits for") {
  std::vector<PlannedJob> jobs = jobs_of(48);
  for (PlannedJob& job : jobs) job.stage = "climb";
  jobs.push_back({1, 1'000'000, 0, 0, 2.0, {}, "join"});
  const PlannedFarm farm = farm_of({{24, 1}});
  const auto stages = simulate_stages(jobs, farm);
  REQUIRE(stages.size() == 2);
  CHECK(stages[0].name == "climb");
  CHECK(stages[0].jobs == 48);
  CHECK(stages[0].takes_s >= stages[0].ideal_s);
  CHECK(stages[0].storage_s == doctest::Approx(48 * 3.6e6 / 12.5e9));  // the sink reads results
  CHECK(stages[1].longest_s == doctest::Approx(2));
  CHECK(stages[1].ideal_s == doctest::Approx(2.0 / 24));
  CHECK(stages[1].takes_s == doctest::Approx(2).epsilon(0.05));
  CHECK(stages[0].takes_s + stages[1].takes_s == doctest::Approx(simulate_run(jobs, farm).farm_s));
}

}  // namespace
}  // namespace meshfarm
