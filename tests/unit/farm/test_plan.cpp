// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/plan.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {
namespace {

JobOutput planned_output(JobKey key) {
  return {{to_string(ResultName{key.value, 1, 1}), 1, 1}, "made"};
}

Plan started_plan(JobSource source) {
  Plan plan(std::move(source), 3);
  plan.restart({});
  return plan;
}

TEST_CASE("nothing is known before the sink has told what it has") {
  Plan plan(one_stage(3), 3);
  CHECK_FALSE(plan.started());
  CHECK_FALSE(plan.issue());
  CHECK_FALSE(plan.complete());
}

TEST_CASE("the largest job is given out first, equals as asked for") {
  const std::vector<Job> jobs = {make_job("a", 1), make_job("b", 5), make_job("c", 3),
                                 make_job("d", 5)};
  Plan plan = started_plan(in_stages({jobs}));
  std::string order;
  while (const auto issued = plan.issue()) order += issued->job.parameters;
  CHECK(order == "bdca");
  CHECK(plan.counts().running == 4);
  CHECK(plan.counts().cost_known == 14);
}

TEST_CASE("what leads to much is given out first, but for who may take small jobs only") {
  std::vector<Job> jobs = {make_job("a", 4), make_job("b", 1), make_job("c", 3)};
  jobs[1].after = 5;
  Plan plan = started_plan(in_stages({jobs}));
  CHECK(plan.counts().cost_known == 8);
  CHECK(plan.issue({.max_cost = 3})->job.parameters == "b");
  CHECK(plan.issue({.max_cost = 3})->job.parameters == "c");
  CHECK_FALSE(plan.issue({.max_cost = 3}));
  CHECK(plan.issue()->job.parameters == "a");
}

TEST_CASE("a small job is found behind very many large ones") {
  std::vector<Job> jobs = {make_job("small", 1)};
  for (int i = 0; i < 1000; ++i) jobs.push_back(make_job("large " + std::to_string(i), 10));
  Plan plan = started_plan(in_stages({jobs}));
  CHECK(plan.issue({.max_cost = 3})->job.parameters == "small");
  CHECK_FALSE(plan.issue({.max_cost = 3}));
}

/// A job that reads an extent.
Job reading(const std::string& name, std::uint64_t cost, std::uint64_t extent) {
  Job job = make_job(name, cost);
  job.extent = {extent, 1};
  return job;
}

std::string order_for(Plan& plan, const JobChoice& choice) {
  std::string order;
  while (const auto issued = plan.issue(choice)) order += issued->job.parameters;
  return order;
}

TEST_CASE("a host is given jobs at home there first, then those that are nowhere at home") {
  Plan plan = started_plan(in_stages({{reading("a", 100, 1), make_job("b", 99), reading("c", 98, 2),
                                       reading("d", 97, 3), reading("e", 96, 2)}}));
  plan.set_home(1, 7);
  plan.set_home(2, 8);
  CHECK(plan.home(2) == 8);
  CHECK(plan.home(3) == 0);
  SUBCASE("the one") {
    CHECK(order_for(plan, {.host = 8}) == "cebda");
  }
  SUBCASE("the other") {
    CHECK(order_for(plan, {.host = 7}) == "abdce");
  }
  SUBCASE("who has nothing") {
    CHECK(order_for(plan, {.host = 9}) == "bdace");
  }
  SUBCASE("nobody in particular") {
    CHECK(order_for(plan, {}) == "abcde");
  }
  SUBCASE("an extent that moves") {
    plan.set_home(2, 7);
    CHECK(order_for(plan, {.host = 8}) == "bdace");
  }
  SUBCASE("after a restart") {
    plan.restart({});
    CHECK(order_for(plan, {.host = 8}) == "cebda");
  }
  SUBCASE("where some do not fit") {
    CHECK(order_for(plan, {.max_cost = 97, .host = 8}) == "ed");
  }
}

TEST_CASE("much longer jobs go before those at home") {
  Plan plan =
      started_plan(in_stages({{reading("a", 100, 2), reading("b", 70, 1), reading("c", 80, 1)}}));
  plan.set_home(1, 7);
  plan.set_home(2, 8);
  CHECK(order_for(plan, {.host = 7}) == "cab");
}

TEST_CASE("what a job reads with others is no part of what it is") {
  const Job job = reading("a", 1, 5);
  CHECK(key_of(job) == key_of(make_job("a")));
  CHECK(extent_named("part", 1, 5).bytes == 5);
  CHECK(extent_named("part", 1, 5).name == extent_named("part", 1, 6).name);
  CHECK(extent_named("part", 1, 5).name != extent_named("part", 2, 5).name);
  CHECK(extent_named("part", 1, 5).name != extent_named("vertices", 1, 5).name);
}

/// A job for the sink, and one for workers.
JobSource with_job_of_sink() {
  std::vector<Job> jobs = {make_job("theirs"), make_job("sink's")};
  jobs[1].by_sink = true;
  return in_stages({jobs});
}

TEST_CASE("a job of the sink is never issued, and runs until it is accepted") {
  Plan plan = started_plan(with_job_of_sink());
  const JobKey theirs = key_of(make_job("theirs")), own = key_of(make_job("sink's"));
  CHECK(plan.state(own) == JobState::running);
  CHECK(plan.counts().running == 1);
  CHECK(plan.counts().at_sink == 1);
  const auto issued = plan.issue();
  REQUIRE(issued);
  CHECK(issued->key == theirs);
  CHECK_FALSE(plan.issue());
  CHECK(plan.accept(theirs, planned_output(theirs)));
  CHECK_FALSE(plan.complete());
  CHECK_FALSE(plan.stuck());
  plan.give_back(own);  // no worker has it
  CHECK(plan.state(own) == JobState::running);
  CHECK(plan.accept(own, planned_output(own)));
  CHECK(plan.complete());
  CHECK(plan.counts().at_sink == 0);
  plan.restart({{theirs, planned_output(theirs)}});  // a sink that lost it does it again
  CHECK(plan.state(own) == JobState::running);
  CHECK(plan.counts().at_sink == 1);
  CHECK(plan.ready_jobs().empty());
}

TEST_CASE("a source that wants nothing is complete at once") {
  CHECK(started_plan(one_stage(0)).complete());
}

TEST_CASE("a job given back is ready again under another attempt, without blame") {
  Plan plan = started_plan(one_stage(1));
  for (std::uint32_t attempt = 1; attempt <= 10; ++attempt) {
    const auto issued = plan.issue();
    REQUIRE(issued);
    CHECK(issued->attempt == attempt);
    CHECK_FALSE(plan.issue());
    plan.give_back(issued->key);
    CHECK(plan.state(issued->key) == JobState::ready);
  }
  CHECK(plan.counts().retries == 9);
}

TEST_CASE("three failed attempts give a job up, with their reasons") {
  Plan plan = started_plan(one_stage(1));
  for (const std::string reason : {"first", "second", "third"}) {
    CHECK_FALSE(plan.stuck());
    const auto issued = plan.issue();
    REQUIRE(issued);
    plan.fail_attempt(issued->key, reason, Failing::attempt);
  }
  CHECK(plan.stuck());
  CHECK_FALSE(plan.complete());
  CHECK_FALSE(plan.issue());
  REQUIRE(plan.lost().size() == 1);
  CHECK(plan.lost()[0].reasons == "first; second; third");
}

TEST_CASE("an input that is bad for good fails its job at once, the others go on") {
  Plan plan = started_plan(one_stage(2));
  plan.fail_attempt(plan.issue()->key, "no mesh", Failing::for_good);
  CHECK(plan.counts().failed == 1);
  CHECK_FALSE(plan.stuck());
  const JobKey other = plan.issue()->key;
  CHECK(plan.accept(other, planned_output(other)));
  CHECK(plan.stuck());
}

TEST_CASE("an accepted job stays accepted") {
  Plan plan = started_plan(one_stage(2));
  const auto issued = plan.issue();
  CHECK(plan.accept(issued->key, planned_output(issued->key)));
  CHECK_FALSE(plan.accept(issued->key, planned_output(issued->key)));
  plan.give_back(issued->key);
  plan.fail_attempt(issued->key, "late", Failing::for_good);
  CHECK(plan.state(issued->key) == JobState::done);
  CHECK(plan.counts().done == 1);
  CHECK_FALSE(plan.accept(JobKey{99}, planned_output(JobKey{99})));
  CHECK_FALSE(plan.state(JobKey{99}));
}

TEST_CASE("a late result counts even for a job that waits or was given up") {
  Plan plan = started_plan(one_stage(2));
  const JobKey waits = plan.issue()->key;
  plan.give_back(waits);
  CHECK(plan.accept(waits, planned_output(waits)));
  const JobKey failed = plan.issue()->key;
  plan.fail_attempt(failed, "bad", Failing::for_good);
  CHECK(plan.stuck());
  CHECK(plan.accept(failed, planned_output(failed)));
  CHECK(plan.complete());
}

TEST_CASE("stages follow each other, and a restart goes straight to the jobs that are open") {
  const JobSource source = in_stages({{make_job("a"), make_job("b")}, {make_job("c")}});
  const JobKey a = key_of(make_job("a"));
  const JobKey b = key_of(make_job("b"));
  const JobKey c = key_of(make_job("c"));
  Plan plan = started_plan(source);
  plan.accept(a, planned_output(a));
  CHECK_FALSE(plan.state(c));
  plan.accept(b, planned_output(b));
  CHECK(plan.state(c) == JobState::ready);
  CHECK(plan.issue()->key == c);

  SUBCASE("the sink knows all") {
    plan.restart({{a, planned_output(a)}, {b, planned_output(b)}});
    CHECK(plan.state(c) == JobState::running);
    CHECK(plan.counts().running == 1);
    CHECK(plan.accept(c, planned_output(c)));
    CHECK(plan.complete());
  }
  SUBCASE("the sink lost a job of the first stage") {
    plan.restart({{a, planned_output(a)}});
    CHECK(plan.state(b) == JobState::ready);
    CHECK(plan.counts().running == 0);  // c is not wanted yet
    plan.give_back(c);                  // its worker is lost meanwhile
    CHECK(plan.issue()->key == b);
    CHECK_FALSE(plan.issue());
    plan.accept(b, planned_output(b));
    CHECK(plan.issue()->key == c);
  }
  SUBCASE("the sink has all") {
    plan.restart({{a, planned_output(a)}, {b, planned_output(b)}, {c, planned_output(c)}});
    CHECK(plan.complete());
    CHECK(plan.counts().done == 3);
  }
}

TEST_CASE("a job that needs what was made again reads that") {
  const JobKey first = key_of(make_job("first"));
  const JobSource source = [] {
    JobGraph graph({"first", "then"});
    graph.add({0, 0}, make_job("first"));
    graph.add({1, 0}, {{0, 0}}, [](JobGraph& so_far) {
      Job job = make_job("then");
      job.inputs = {so_far.output({0, 0}).file};
      return job;
    });
    return graph;
  };
  Plan plan = started_plan(source);
  plan.accept(first, {{"made", 5, 6}, ""});
  const IssuedJob before = *plan.issue();
  CHECK(before.job.inputs.at(0).name == "made");
  plan.restart({});
  plan.accept(first, {{"made again", 5, 6}, ""});
  CHECK(plan.state(before.key) == JobState::running);
  plan.give_back(before.key);
  CHECK(plan.issue()->job.inputs.at(0).name == "made again");
}

}  // namespace
}  // namespace meshfarm::test
