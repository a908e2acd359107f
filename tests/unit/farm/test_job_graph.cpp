// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <malloc.h>

#include <meshfarm/farm/plan.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {
namespace {

JobOutput made_of(const Job& job) {
  return {{to_string(ResultName{key_of(job).value, 1, 1}), 1, 1}, "<" + job.parameters + ">"};
}

std::string names_of(const std::vector<WantedJob>& jobs) {
  std::string names;
  for (const WantedJob& each : jobs) names += each.job.parameters + " ";
  return names;
}

std::vector<WantedJob> accept(JobGraph& graph, const std::string& name) {
  const Job job = make_job(name);
  return graph.accept(key_of(job), made_of(job));
}

JobGraph::Make make_of(const std::string& name) {
  return [name](JobGraph&) { return make_job(name); };
}

TEST_CASE("a job is possible once all that it needs is accepted") {
  JobGraph graph({"first", "second"});
  for (std::uint32_t i = 0; i < 3; ++i) graph.add({0, i}, make_job("a" + std::to_string(i)));
  graph.add({1, 0}, {{0, 0, 2}}, make_of("b"));
  graph.add({1, 1}, {{0, 2}, {1, 0}}, make_of("c"));
  CHECK(names_of(graph.begin()) == "a0 a1 a2 ");
  CHECK(names_of(accept(graph, "a1")).empty());
  CHECK(names_of(accept(graph, "a1")).empty());  // it is known already
  CHECK(names_of(accept(graph, "b")).empty());   // nobody asked for it yet
  CHECK(names_of(accept(graph, "a0")) == "b ");
  CHECK(names_of(accept(graph, "b")).empty());
  CHECK_FALSE(graph.complete());
  CHECK(graph.progress() == std::vector<StageProgress>{{"first", 3, 2}, {"second", 1, 1}});
  CHECK(names_of(accept(graph, "a2")) == "c ");
  accept(graph, "c");
  CHECK(graph.complete());
  CHECK(graph.outputs().size() == 5);
  const JobPlace place = graph.place({1, 1});
  CHECK(place.stage == "second");
  REQUIRE(place.needs.size() == 2);
  CHECK(place.needs[0].stage == "first");
  CHECK(place.needs[0].first == 2);
}

TEST_CASE("what a step adds depends on outputs, and needs what the step needed") {
  JobGraph graph({"first", "second", "third"});
  graph.add({0, 0}, make_job("a"));
  graph.then({{0, 0}}, [](JobGraph& so_far) {
    so_far.add({1, 0}, make_job("of " + so_far.output({0, 0}).summary));
    so_far.add({2, 0}, {{1, 0}}, make_of("last"));
  });
  CHECK(names_of(graph.begin()) == "a ");
  CHECK(names_of(accept(graph, "a")) == "of <a> ");
  CHECK(graph.needs({1, 0}) == JobNeeds{{0, 0}});
  CHECK(graph.needs({2, 0}) == JobNeeds{{0, 0}, {1, 0}});
  CHECK(names_of(accept(graph, "of <a>")) == "last ");
}

TEST_CASE("where there is no job to do, what needs it goes on") {
  JobGraph graph({"first", "second"});
  graph.add({0, 0}, {}, [](JobGraph&) { return std::optional<Job>(); });
  graph.add({1, 0}, {{0, 0}}, make_of("b"));
  CHECK(names_of(graph.begin()) == "b ");
  accept(graph, "b");
  CHECK(graph.complete());
  CHECK(graph.outputs().size() == 1);
}

TEST_CASE("a job under two names is done once, though one is asked for late") {
  JobGraph graph({"first", "second"});
  graph.add({0, 0}, make_job("a"));
  graph.add({0, 1}, make_job("a"));
  graph.add({0, 2}, make_job("b"));
  graph.add({1, 0}, {{0, 1}, {0, 2}}, make_of("a"));
  CHECK(names_of(graph.begin()) == "a b ");
  accept(graph, "a");
  CHECK(accept(graph, "b").empty());
  CHECK(graph.complete());
  CHECK(graph.outputs().size() == 4);
  CHECK(graph.jobs_wanted() == 2);
}

TEST_CASE("what nobody adds is waited for; a name is given once") {
  JobGraph graph({"only"});
  graph.add({0, 1}, {{0, 0}}, make_of("b"));
  CHECK(graph.begin().empty());
  CHECK_FALSE(graph.complete());
  CHECK_THROWS_AS(graph.add({0, 1}, make_job("b")), Error);
  CHECK_THROWS_AS(graph.output({0, 1}), Error);
}

/// Some jobs depend on several outputs, some become known late, some are identical.
JobGraph tangled() {
  JobGraph graph({"leaf", "pair", "late", "end"});
  constexpr std::uint32_t k_leaves = 20;
  for (std::uint32_t i = 0; i < k_leaves; ++i) {
    graph.add({0, i}, make_job("leaf " + std::to_string(i % 17)));
  }
  for (std::uint32_t i = 0; i + 1 < k_leaves; i += 2) {
    graph.add({1, i / 2}, {{0, i, 2}}, [i](JobGraph& so_far) {
      return make_job(so_far.output({0, i}).summary + so_far.output({0, i + 1}).summary);
    });
    graph.then({{1, i / 2}}, [i](JobGraph& so_far) {
      const std::string& made = so_far.output({1, i / 2}).summary;
      if (made.size() % 2 != 0) so_far.add({2, i}, make_job("odd " + made));
      so_far.add({2, i + 1}, {{0, k_leaves - 1}}, [made](JobGraph&) {
        return made.size() % 3 == 0 ? std::optional<Job>() : make_job("more " + made);
      });
    });
  }
  graph.then({{1, 0, k_leaves / 2}}, [](JobGraph& so_far) {
    std::string all;
    for (std::uint32_t i = 0; i < k_leaves / 2; ++i) all += so_far.output({1, i}).summary;
    so_far.add({3, 0}, make_job("end " + all));
  });
  return graph;
}

/// Accepts in random order. Returns each job with what it needed, and the outputs.
std::string outcome(std::uint32_t seed) {
  JobGraph graph = tangled();
  std::mt19937 random(seed);
  std::vector<WantedJob> open = graph.begin();
  std::map<std::string, JobNeeds> seen;
  while (!open.empty()) {
    std::swap(open[random() % open.size()], open.back());
    const WantedJob next = std::move(open.back());
    open.pop_back();
    seen[next.job.parameters] = graph.needs(next.name);
    for (WantedJob& each : graph.accept(next.key, made_of(next.job))) {
      open.push_back(std::move(each));
    }
  }
  std::string all = graph.complete() ? "complete " : "incomplete ";
  for (const auto& [name, needs] : seen) {
    all += name + ":";
    for (const JobRange& each : needs) {
      all += std::to_string(each.stage) + "." + std::to_string(each.first) + "+" +
             std::to_string(each.count) + ",";
    }
  }
  for (const AcceptedJob& each : graph.outputs()) all += each.output.summary + "\n";
  return all;
}

TEST_CASE("the outcome does not depend on the order in which jobs are accepted") {
  const std::string first = outcome(0);
  CHECK(first.substr(0, 8) == "complete");
  int others = 0;
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) others += outcome(seed) == first ? 0 : 1;
  CHECK(others == 0);
}

/// A tree: each job of a level needs its children on the level below.
JobSource tree_of(std::uint32_t jobs, std::uint32_t levels, std::uint32_t children) {
  return [=] {
    std::vector<std::string> names(levels, "level");
    JobGraph graph(std::move(names));
    std::uint32_t width = jobs;
    for (std::uint32_t level = 0; level < levels; ++level) {
      const std::uint32_t below = width;
      if (level > 0) width = (width + children - 1) / children;
      for (std::uint32_t i = 0; i < width; ++i) {
        JobNeeds needs;
        if (level > 0) {
          needs = {{level - 1, i * children, std::min(children, below - i * children)}};
        }
        graph.add({level, i}, needs, [level, i](JobGraph&) {
          return make_job("job " + std::to_string(level) + "." + std::to_string(i), i % 1000);
        });
      }
    }
    return graph;
  };
}

/// Bytes allocated by the process; 0 if a sanitizer replaces the allocator.
std::size_t allocated() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST_CASE("a tree of a hundred thousand jobs is planned in a moment and 200 MB") {
  const std::size_t before = allocated();
  std::size_t most = before;
  const std::clock_t start = std::clock();  // CPU time, as others may use the machine, too
  Plan plan(tree_of(75'000, 8, 4), 3);
  plan.restart({});
  std::uint64_t done = 0;
  while (const auto issued = plan.issue()) {
    plan.accept(issued->key, made_of(issued->job));
    if (++done % 1000 == 0) most = std::max(most, allocated());
  }
  CHECK(plan.complete());
  CHECK(done > 99'000);
  const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  MESSAGE(done, " jobs planned in ", took, " s of processor time");
  CHECK(took < 10);  // it takes half a second without sanitizers
  MESSAGE("they take ", (most - before) >> 20, " MiB");
  CHECK(most - before < std::size_t{200} << 20);
}

}  // namespace
}  // namespace meshfarm::test
