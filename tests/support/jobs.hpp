// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm::test {

inline Job make_job(const std::string& name, std::uint64_t cost = 1) {
  return {"test", {}, name, cost};
}

inline std::vector<Job> make_jobs(std::size_t count, const std::string& prefix = "job ") {
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < count; ++i) jobs.push_back(make_job(prefix + std::to_string(i), i));
  return jobs;
}

/// Stages of jobs; each job needs all jobs of the previous stage.
inline JobSource in_stages(const std::vector<std::vector<Job>>& stages) {
  return [stages] {
    std::vector<std::string> names;
    for (std::size_t s = 0; s < stages.size(); ++s) names.push_back("stage " + std::to_string(s));
    JobGraph graph(names);
    JobNeeds needs;
    for (std::uint32_t s = 0; s < stages.size(); ++s) {
      for (std::uint32_t i = 0; i < stages[s].size(); ++i) {
        graph.add({s, i}, needs, [job = stages[s][i]](JobGraph&) { return job; });
      }
      needs = {all_of(s, stages[s].size())};
    }
    return graph;
  };
}

/// One stage of `count` jobs.
inline JobSource one_stage(std::size_t count) {
  return in_stages({make_jobs(count)});
}

}  // namespace meshfarm::test
