// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/made_up_run.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {
namespace {

/// Whether a run needs the job with these parameters; `summaries` are the run's outputs.
bool needs(std::span<const std::string> summaries, const std::string& parameters) {
  Job job;
  job.parameters = parameters;
  return !parameters.empty() &&
         std::find(summaries.begin(), summaries.end(), simulated_summary(job)) != summaries.end();
}

/// The problem of one run that ended.
std::string problem_of_end(const std::string& failure, std::span<const AcceptedJob> outputs,
                           const SimulatedFaults& faults, std::span<const std::string> expected) {
  const bool hopeless = needs(expected, faults.poison) || needs(expected, faults.bad);
  if (hopeless) return failure.empty() ? "a job that cannot be done was done" : "";
  if (!failure.empty()) return "it failed: " + failure;
  const bool same = std::equal(
      outputs.begin(), outputs.end(), expected.begin(), expected.end(),
      [](const AcceptedJob& made, const std::string& each) { return made.output.summary == each; });
  return same ? "" : "it ended with other bytes";
}

}  // namespace

Job made_up_job(const std::string& name) {
  Job job;
  job.kind = "simulated";
  job.parameters = name;
  job.cost = 100 + checksum(name) % 900;
  job.memory = job.cost << 20;  // 100 MiB to 1 GiB
  return job;
}

std::string simulated_summary(const Job& job) {
  return to_hex(checksum("made of " + job.parameters));
}

JobSource simulated_jobs(std::uint64_t count, const std::string& target) {
  const std::uint64_t last = count / 16;
  const std::uint64_t first = count - last - std::min<std::uint64_t>(count, 1);
  const auto named = [&](const std::string& name, std::uint64_t many, std::uint64_t common) {
    std::vector<Job> jobs;
    for (std::uint64_t i = 0; i < many; ++i) {
      jobs.push_back(made_up_job((i < common ? "" : target) + name + std::to_string(i)));
    }
    return jobs;
  };
  // Shared by all copies of the source: each simulated process has one.
  const auto shared = [](std::vector<Job> jobs) {
    return std::make_shared<const std::vector<Job>>(std::move(jobs));
  };
  return [most = shared(named("job ", first, first / 4)), rest = shared(named("end ", last, 0))] {
    constexpr std::uint32_t k_most = 0, k_all = 1, k_rest = 2;
    JobGraph graph({"most", "all", "rest"});
    std::uint32_t jobs = 0;
    for (const Job& job : *most) graph.add({k_most, jobs++}, job);
    graph.add({k_all, 0}, {all_of(k_most, jobs)}, [jobs](JobGraph& so_far) {
      const std::string needs = jobs == 0 ? "nothing" : so_far.output({k_most, jobs - 1}).summary;
      Job all = made_up_job("all, to " + needs);
      all.by_sink = true;
      return all;
    });
    graph.then({{k_all, 0}}, [rest](JobGraph& so_far) {
      for (std::uint32_t i = 0; i < rest->size(); ++i) {
        Job job = (*rest)[i];
        job.inputs = {so_far.output({k_most, i}).file, so_far.output({k_all, 0}).file};
        so_far.add({k_rest, i}, std::move(job));
      }
    });
    return graph;
  };
}

std::vector<std::string> expected_summaries(const JobSource& source) {
  JobGraph graph = source();
  std::vector<WantedJob> jobs = graph.begin();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    JobOutput output;
    output.summary = simulated_summary(jobs[i].job);
    for (WantedJob& each : graph.accept(jobs[i].key, output)) jobs.push_back(std::move(each));
  }
  std::vector<std::string> summaries;
  for (const AcceptedJob& each : graph.outputs()) summaries.push_back(each.output.summary);
  return summaries;
}

std::string problem_of(const SimulationResult& result, const SimulatedFaults& faults,
                       std::span<const std::string> expected, std::span<const std::string> other) {
  if (!result.broken.empty()) return "broken: " + result.broken;
  if (!result.ended) return "it did not come to its end";
  std::string problem = problem_of_end(result.failure, result.outputs, faults, expected);
  if (!problem.empty() || other.empty()) return problem;
  problem = problem_of_end(result.other_failure, result.other_outputs, faults, other);
  return problem.empty() ? "" : "the other run: " + problem;
}

}  // namespace meshfarm
